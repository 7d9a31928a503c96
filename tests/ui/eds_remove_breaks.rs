//! A removal that makes a sound file unsound.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/sound.eds";
        remove 0x1018;
    }
}

fn main() {}
