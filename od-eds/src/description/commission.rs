//! The content of a DCF that an EDS lacks: one device, configured (CiA 306-1, chapter 5).

use alloc::string::String;
use alloc::vec::Vec;

use crate::description::{Description, Section, Value};
use crate::span::Spanned;
use od_model::{DataType, Kind};

const COMMISSIONING: &str = "DeviceComissioning";

impl Description {
    /// Sets a key of `[DeviceComissioning]`, whichever spelling the file has.
    ///
    /// ```
    /// let mut description = od_eds::Description::default();
    /// description.commission("NodeID", "5");
    /// assert_eq!(description.commissioned_node_id(), Some(5));
    /// ```
    pub fn commission(&mut self, key: &str, value: &str) {
        let is_it = |section: &Section| {
            let name = &section.name.value;
            name.eq_ignore_ascii_case(COMMISSIONING)
                || name.eq_ignore_ascii_case("DeviceCommissioning")
        };
        let at = match self.sections.iter().position(is_it) {
            Some(at) => at,
            None => {
                self.sections.push(Section {
                    name: Spanned::from(String::from(COMMISSIONING)),
                    pairs: Vec::new(),
                });
                self.sections.len() - 1
            }
        };
        let pairs = &mut self.sections[at].pairs;
        let value = Spanned::from(String::from(value));
        match pairs.iter_mut().find(|(k, _)| k.eq_ignore_ascii_case(key)) {
            Some((_, old)) => *old = value,
            None => pairs.push((Spanned::from(String::from(key)), value)),
        }
    }
}

impl Value {
    /// A value as it goes over the bus, as a description has it.
    ///
    /// ```
    /// use od_eds::Value;
    /// use od_model::DataType;
    ///
    /// assert_eq!(Value::from_wire(DataType::Integer8, vec![0xFF]), Value::Signed(-1));
    /// ```
    pub fn from_wire(data_type: DataType, bytes: Vec<u8>) -> Self {
        let mut wide = [0; 8];
        let size = bytes.len().min(8);
        wide[..size].copy_from_slice(&bytes[..size]);
        match data_type.kind() {
            Kind::Text => Self::Text(String::from_utf8_lossy(&bytes).into_owned()),
            Kind::Bytes | Kind::Record => Self::Bytes(bytes),
            Kind::Boolean | Kind::Unsigned => Self::Unsigned(u64::from_le_bytes(wide)),
            Kind::Signed => {
                let unused = 64 - 8 * size.max(1) as u32;
                Self::Signed(i64::from_le_bytes(wide) << unused >> unused)
            }
            Kind::Real if size == 4 => {
                let [a, b, c, d, ..] = wide;
                Self::Real(f64::from(f32::from_le_bytes([a, b, c, d])))
            }
            Kind::Real => Self::Real(f64::from_le_bytes(wide)),
        }
    }
}
