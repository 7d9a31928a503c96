//! A removal that adds an error to a valid file.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/sound.eds";
        remove 0x1018;
    }
}

fn main() {}
