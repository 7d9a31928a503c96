//! A change that adds an error to a valid file.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/sound.eds";
        modify 0x2300 { default = 300 }
    }
}

fn main() {}
