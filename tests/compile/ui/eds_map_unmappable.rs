//! A mapping of an object that no PDO can carry.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/map_unmappable.eds";
    }
}

fn main() {}
