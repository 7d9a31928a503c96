//! Tests of the server through its messages, in one process.

mod asking;
mod calls;
mod findings;
mod life;
mod networks;
mod support;
mod writing;
mod xdd;
