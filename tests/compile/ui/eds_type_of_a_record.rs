//! A value with the type of a whole object.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../od-eds/cases/E0403/bad.eds";
    }
}

fn main() {}
