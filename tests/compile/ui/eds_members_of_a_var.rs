//! A VAR with sub-indices.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0305/bad.eds";
    }
}

fn main() {}
