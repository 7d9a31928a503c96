//! A call without a module.

use od_macros::object_dictionary;

object_dictionary! {}

fn main() {}
