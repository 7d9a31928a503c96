//! An ObjectType that is no object code.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../cases/rules/E0301/bad.eds";
    }
}

fn main() {}
