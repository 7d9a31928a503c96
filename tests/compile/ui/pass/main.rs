//! Valid calls compile, and their dictionaries are right.

mod at_every_visibility;
mod corrected;
mod from_a_file;
mod inside_macro_rules;
mod long_array;
mod names_of_every_kind;
mod odd_but_sound;
mod under_another_path;
