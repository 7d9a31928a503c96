//! The identity of a device by its description.

use pyo3::prelude::*;

use crate::files::read::Read;

/// The identity of a device: 1000h and 1018h of its description, else `[DeviceInfo]`.
#[pyclass(frozen, get_all, eq, module = "odkit")]
#[derive(Clone, PartialEq)]
pub(crate) struct Identity {
    /// 1000h; bits 0 to 15 are the profile.
    device_type: Option<u64>,
    /// The number of the device profile, such as 406; `None` without one.
    profile: Option<u64>,
    /// 1018h:01.
    vendor_id: Option<u64>,
    /// 1018h:02.
    product_code: Option<u64>,
    /// 1018h:03.
    revision_number: Option<u64>,
    /// 1018h:04; of a DCF its LSS_SerialNumber, too.
    serial_number: Option<u64>,
    /// VendorName.
    vendor_name: Option<String>,
    /// ProductName.
    product_name: Option<String>,
    /// OrderCode.
    order_code: Option<String>,
}

impl Identity {
    pub(crate) fn of(read: &Read) -> Self {
        let info = |key| read.info(key).map(str::to_owned);
        let number = |sub, key| {
            let given = || u64::try_from(od_model::values::integer(read.info(key)?)?).ok();
            read.number(0x1018, sub).or_else(given)
        };
        let device_type = read.number(0x1000, 0);
        let commissioned = || read.description.commissioning()?.serial_number;
        Self {
            device_type,
            profile: device_type
                .map(|number| number & 0xFFFF)
                .filter(|number| *number != 0),
            vendor_id: number(1, "VendorNumber"),
            product_code: number(2, "ProductNumber"),
            revision_number: number(3, "RevisionNumber"),
            serial_number: read
                .number(0x1018, 4)
                .filter(|number| *number != 0)
                .or_else(|| commissioned().map(u64::from)),
            vendor_name: info("VendorName"),
            product_name: info("ProductName"),
            order_code: info("OrderCode"),
        }
    }
}

#[pymethods]
impl Identity {
    fn __repr__(&self) -> String {
        let mut words = Vec::new();
        words.extend(self.vendor_name.clone());
        words.extend(self.product_name.clone());
        for (what, number) in [
            ("vendor-ID", self.vendor_id),
            ("product code", self.product_code),
            ("revision number", self.revision_number),
            ("serial number", self.serial_number),
        ] {
            words.extend(number.map(|number| format!("{what} {number:08X}h")));
        }
        words.extend(self.profile.map(|number| format!("CiA {number}")));
        format!("<odkit.Identity {}>", words.join(", "))
    }
}
