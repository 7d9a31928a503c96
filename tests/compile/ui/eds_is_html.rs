//! A page of the server instead of the file.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/page.eds";
    }
}

fn main() {}
