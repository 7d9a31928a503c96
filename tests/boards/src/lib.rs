//! Only the versions of the dependencies count.
