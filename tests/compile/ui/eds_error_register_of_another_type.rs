//! 1001h of another data type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../od-eds/cases/E0605/bad.eds";
    }
}

fn main() {}
