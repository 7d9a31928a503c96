//! Two TPDOs of the file have one COB-ID, and a third one leaves 11 bits.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/cob_ids.eds";
    }
}

fn main() {}
