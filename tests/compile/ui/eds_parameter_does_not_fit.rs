//! A configured value that is none of its type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../od-eds/cases/E0413/bad.eds";
    }
}

fn main() {}
