//! Texts of the commands and the wizard about a slave.

use od_client::lss::Identity;

use crate::bus::names::Names;
use crate::output::note;

/// A slave in one line.
pub(super) fn title(one: &Identity, names: &Names) -> String {
    let known = fits(one, names).map_or(String::new(), |name| format!("  {name}"));
    format!(
        "serial number {:<10}  vendor-ID {:X}h, product code {:X}h, revision {:X}h{known}",
        one.serial, one.vendor, one.product, one.revision
    )
}

pub(super) fn fits<'n>(one: &Identity, names: &'n Names) -> Option<&'n str> {
    // A file for a node ID does not describe a slave without one.
    let identity = one.parts().map(Some);
    names.fitting(None, identity).map(|known| known.name)
}

/// A line of the wizard.
pub(super) fn tell(text: &str) {
    note!("{text}");
}
