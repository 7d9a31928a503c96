//! Warnings of the rules about a file: one for each rule.
#![deny(deprecated)] // so that the warnings are in the expected output

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/odd_but_sound.eds";
    }
}

fn main() {}
