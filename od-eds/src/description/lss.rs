//! LSS services that `[DeviceInfo]` declares.

use alloc::format;

use super::Description;

/// kbit/s at each index of the LSS bit timing table (CiA 305, chapter 6.4.3); index 5 is reserved.
const KBIT: [u16; 9] = [1000, 800, 500, 250, 125, 0, 50, 20, 10];

impl Description {
    /// Returns whether a key of `[DeviceInfo]` is there and not 0.
    pub fn info_is_set(&self, key: &str) -> bool {
        let info = self.section("DeviceInfo");
        let value = info.and_then(|info| info.get(key));
        let number = value.and_then(|value| od_model::values::integer(value.value.trim()));
        number.is_some_and(|number| number != 0)
    }

    /// Returns the bit rates that LSS can set, by their index in the bit timing table; all of the
    /// table if the file names none. `None`: the file lacks `LSS_Supported=1` (CiA 306-1).
    pub fn lss_bit_rates(&self) -> Option<[bool; 9]> {
        if !self.info_is_set("LSS_Supported") {
            return None;
        }
        let named = KBIT.map(|kbit| kbit != 0 && self.info_is_set(&format!("BaudRate_{kbit}")));
        Some(if named.contains(&true) {
            named
        } else {
            KBIT.map(|kbit| kbit != 0)
        })
    }
}
