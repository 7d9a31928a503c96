//! The overlay comes before its base.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/wrong.overlay" + "../../eds/small.eds";
    }
}

object_dictionary! {
    mod named {
        eds = "eds/names_its_base.overlay" + "eds/wrong.overlay";
    }
}

fn main() {}
