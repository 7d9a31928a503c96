//! The file is an overlay, without its base.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/removes_nothing.overlay";
    }
}

object_dictionary! {
    mod named {
        eds = "eds/names_its_base.overlay";
    }
}

fn main() {}
