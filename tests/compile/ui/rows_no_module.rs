//! A call that begins with something else than a module.

use odkit::object_dictionary;

object_dictionary! {
    pub struct Device;
}

fn main() {}
