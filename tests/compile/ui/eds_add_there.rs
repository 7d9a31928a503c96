//! An addition of an object that the file already has.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/sound.eds";
        add 0x2300 { name = "Reset"; type = u8 }
    }
}

fn main() {}
