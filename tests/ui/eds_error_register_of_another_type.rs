//! 1001h of another data type.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../cases/rules/E0605/bad.eds";
    }
}

fn main() {}
