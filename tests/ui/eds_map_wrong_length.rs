//! An object that is mapped with another length.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../cases/rules/E0504/bad.eds";
    }
}

fn main() {}
