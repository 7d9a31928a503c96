//! Device descriptions: read, check, fix, convert, compare, and convert to python-canopen.

pub(crate) mod canopen;
pub(crate) mod convert;
pub(crate) mod description;
pub(crate) mod diff;
pub(crate) mod entry;
pub(crate) mod finding;
pub(crate) mod fix;
pub(crate) mod identity;
pub(crate) mod object;
mod read;
pub(crate) mod source;
pub(crate) mod value;
