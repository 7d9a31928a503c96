//! Two overlays.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/sound.eds" + "eds/a.overlay" + "eds/b.overlay";
    }
}

fn main() {}
