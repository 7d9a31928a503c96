//! The device type (1000h), and parts of several rules about profiles.

use od_model::{Address, DataType, ObjectCode};

use crate::description::Description;
use crate::span::Spanned;
use crate::standards::{Checked, checked};
use crate::subject::{Object, start_number};

/// The device type: the number of the profile, and 16 bits that the profile defines.
#[derive(Clone, Copy)]
pub(super) struct DeviceType {
    pub(super) profile: u16,
    additional: u16,
}

impl DeviceType {
    /// Returns whether it is a module of several logical devices, each with a profile of its own.
    pub(super) const fn is_several(self) -> bool {
        self.additional == 0xFFFF
    }

    /// Returns whether this bit of the upper half of 1000h is set; `None` if the upper half is FFFFh, that of a module
    /// of several logical devices (CiA 301, object 1000h).
    pub(super) const fn has(self, bit: u32) -> Option<bool> {
        match self.additional {
            0xFFFF => None,
            bits => Some(bits & 1 << bit != 0),
        }
    }
}

/// The device, if it follows this profile.
pub(super) fn device(description: &Description, profile: u16) -> Option<DeviceType> {
    device_type(description).filter(|device| device.profile == profile)
}

/// The device type, whatever profile it declares.
pub(super) fn device_type(description: &Description) -> Option<DeviceType> {
    let number = start_number(description, Address::new(0x1000, 0))?;
    let number = u32::try_from(number.value).ok()?;
    let [a, b, c, d] = number.to_le_bytes();
    Some(DeviceType {
        profile: u16::from_le_bytes([a, b]),
        additional: u16::from_le_bytes([c, d]),
    })
}

/// The profile of this object. In a module of several logical devices each has its own, in 67FFh and every 800h above
/// (CiA 301, object 1000h).
fn profile_of(description: &Description, index: u16) -> Option<u16> {
    let device = device_type(description)?;
    if !device.is_several() || index < 0x6800 {
        return Some(device.profile);
    }
    let own = Address::new(index | 0x7FF, 0);
    let [low, high, ..] = start_number(description, own)?.value.to_le_bytes();
    Some(u16::from_le_bytes([low, high]))
}

/// Of an I/O module: a bit of 1000h, the objects of which the device must have one, and the
/// channels.
pub(super) const IO_BLOCKS: [(u32, &[u16], &str); 4] = [
    (0, &[0x6000, 0x6100, 0x6120], "digital inputs"),
    (1, &[0x6200, 0x6300, 0x6320], "digital outputs"),
    (
        2,
        &[0x6400, 0x6401, 0x6402, 0x6403, 0x6404],
        "analogue inputs",
    ),
    (
        3,
        &[0x6410, 0x6411, 0x6412, 0x6413, 0x6414],
        "analogue outputs",
    ),
];

/// Returns whether the profile of the device specifies an ARRAY here.
pub(crate) fn is_profile_array(object: &Object<'_>) -> bool {
    in_profile(object).is_some_and(|(_, standard)| standard.code == ObjectCode::Array)
}

/// The type of a value in the profile of the device.
pub(crate) fn profile_type(description: &Description, address: Address) -> Option<DataType> {
    let standard = checked(profile_of(description, address.index)?, address.index)?;
    if standard.code.has_members() && address.sub == 0 {
        Some(DataType::Unsigned8)
    } else {
        standard.types(address.sub).next()
    }
}

/// The profile of the device, and its specification of this object.
pub(crate) fn in_profile(object: &Object<'_>) -> Option<(u16, &'static Checked)> {
    if !matches!(object.index, 0x6000..=0x9FFF) {
        return None;
    }
    let profile = profile_of(object.description, object.index)?;
    Some((profile, checked(profile, object.index)?))
}

/// An encoder (CiA 406), with the default values of its objects.
pub(super) struct Encoder<'a> {
    pub(super) description: &'a Description,
    device: DeviceType,
}

/// Objects that hold the position of an encoder.
pub(super) const POSITIONS: [u16; 4] = [0x6004, 0x6008, 0x6020, 0x6050];

impl<'a> Encoder<'a> {
    /// The device, if it is an encoder.
    pub(super) fn of(description: &'a Description) -> Option<Self> {
        let device = device(description, 406)?;
        Some(Self {
            description,
            device,
        })
    }

    /// The number with which an object starts.
    pub(super) fn value(&self, index: u16) -> Option<Spanned<u64>> {
        start_number(self.description, Address::new(index, 0))
    }

    /// Returns whether its type is not in the profile. FFFFh: several logical devices.
    pub(super) const fn has_unknown_type(&self) -> bool {
        !matches!(self.device.additional, 1..=10 | 0xFFFF)
    }

    /// Returns whether it counts revolutions; `None` for linear and unknown encoders.
    pub(super) const fn is_multiturn(&self) -> Option<bool> {
        match self.device.additional {
            1 => Some(false),
            2 => Some(true),
            _ => None,
        }
    }
}
