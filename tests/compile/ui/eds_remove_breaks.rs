//! A removal that makes a sound file unsound.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/sound.eds";
        remove 0x1018;
    }
}

fn main() {}
