//! An LSS slave in words: its LSS address, and the file that describes it.

use od_client::lss::Identity;

use crate::bus::names::Names;

/// A slave in one line.
pub(super) fn title(one: &Identity, names: &Names) -> String {
    let known = fits(one, names).map_or(String::new(), |name| format!("  {name}"));
    format!(
        "serial number {:<10}  vendor-ID {:X}h, product code {:X}h, revision {:X}h{known}",
        one.serial, one.vendor, one.product, one.revision
    )
}

/// The name of the file that describes it.
pub(super) fn fits<'n>(one: &Identity, names: &'n Names) -> Option<&'n str> {
    // A file for a node ID does not describe a slave without one.
    let identity = one.parts().map(Some);
    names.fitting(None, identity).map(|known| known.name)
}
