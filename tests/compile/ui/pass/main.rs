//! What is right compiles, and does what it says.

mod at_every_visibility;
mod from_a_file;
mod inside_macro_rules;
mod mended;
mod names_of_every_kind;
mod odd_but_sound;
mod under_another_path;
