//! A call without a module.

use odkit::object_dictionary;

object_dictionary! {}

fn main() {}
