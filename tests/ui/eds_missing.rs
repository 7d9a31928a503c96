//! A file that is not there.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "elsewhere/device.eds";
    }
}

fn main() {}
