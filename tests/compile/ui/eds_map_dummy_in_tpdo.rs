//! A dummy in a PDO that is sent.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../od-eds/cases/E0507/bad.eds";
    }
}

fn main() {}
