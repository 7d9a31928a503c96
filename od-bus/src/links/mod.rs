//! Links to real buses, by the name that `--link` takes.

mod slcan;

use crate::fault::Fault;
use crate::link::Link;

/// Opens a link by its name: `slcan:HOST:PORT`.
///
/// # Errors
/// [`Fault::Usage`] if the name is not that of a link, [`Fault::Link`] if it cannot be opened.
pub fn open(name: &str) -> Result<Box<dyn Link>, Fault> {
    match name.split_once(':') {
        Some(("slcan", address)) => Ok(Box::new(slcan::Tcp::open(address)?)),
        _ => Err(Fault::Usage(format!(
            "`{name}` is not a valid link; write `slcan:HOST:PORT`, such as `slcan:127.0.0.1:2000`"
        ))),
    }
}
