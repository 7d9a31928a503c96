//! A configured value outside its limits.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/value_above_limit.eds";
    }
}

fn main() {}
