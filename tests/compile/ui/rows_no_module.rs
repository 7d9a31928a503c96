//! A call that does not begin with a module.

use odkit::object_dictionary;

object_dictionary! {
    pub struct Device;
}

fn main() {}
