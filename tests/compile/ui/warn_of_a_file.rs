//! Warnings of the rules about a file: one for each rule. What a statement brings about is at the statement, although
//! the value is in the file.
#![deny(deprecated)] // so that the warnings are in the expected output

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/odd_but_sound.eds";
        variant narrow { modify 0x2300 { low = 201; high = 210 } }
    }
}

fn main() {}
