//! Device descriptions made from choices, and the expected responses of their devices.

use std::fmt::Write as _;

use od_model::{Address, DataType};

use crate::choices::Choices;
use crate::made::{Made, NODE, value};

/// A PDO of a description.
#[derive(Clone, Debug)]
pub struct Pdo {
    /// Its CAN-ID.
    pub id: u16,
    /// Whether the device receives it.
    pub is_received: bool,
    /// The mapped values, by their index in [`Device::values`].
    pub mapped: Vec<usize>,
}

/// A description.
#[derive(Clone, Debug, Default)]
pub struct Device {
    /// The EDS.
    pub text: String,
    /// Its values without a meaning for a service.
    pub values: Vec<Made>,
    /// Its PDOs: TPDOs are synchronous, RPDOs event-driven.
    pub pdos: Vec<Pdo>,
    sections: String,
    lists: [Vec<u16>; 3],
}

impl Device {
    /// The device that these choices describe.
    pub fn of(choices: &mut Choices<'_>) -> Self {
        let mut device = Self::default();
        device.fixed();
        for number in 0..1 + choices.below(8) as u16 {
            device.object(0x2000 + number * 0x10, choices);
        }
        for number in 0..choices.below(4) as u16 {
            device.pdo(number, false, choices);
        }
        for number in 0..choices.below(3) as u16 {
            device.pdo(number, true, choices);
        }
        device.write();
        device
    }

    /// The mandatory objects.
    fn fixed(&mut self) {
        use DataType::{Unsigned8, Unsigned16, Unsigned32};
        self.var(0x1000, Unsigned32, "const", "0");
        self.var(0x1001, Unsigned8, "ro", "0");
        self.var(0x1005, Unsigned32, "rw", "0x80");
        self.var(0x1017, Unsigned16, "rw", "0");
        self.record(0x1018, 0x9, &[(1, Unsigned32, "const", "0x5F")]);
    }

    fn head(&mut self, index: u16, kind: u8) {
        let list = match index {
            0x1000 | 0x1001 | 0x1018 => 0,
            0x2000..0x6000 => 2,
            _ => 1,
        };
        self.lists[list].push(index);
        let _ = write!(
            self.sections,
            "\n[{index:X}]\nParameterName=Object {index:X}\nObjectType=0x{kind:X}\n"
        );
    }

    fn entry(&mut self, data_type: DataType, access: &str, mappable: bool, default: &str) {
        let _ = write!(
            self.sections,
            "DataType=0x{:04X}\nAccessType={access}\nPDOMapping={}\n",
            data_type.code(),
            u8::from(mappable)
        );
        if !default.is_empty() {
            let _ = writeln!(self.sections, "DefaultValue={default}");
        }
    }

    fn var(&mut self, index: u16, data_type: DataType, access: &str, default: &str) {
        self.head(index, 0x7);
        self.entry(data_type, access, false, default);
    }

    fn sub(&mut self, index: u16, sub: u8) {
        let _ = write!(
            self.sections,
            "\n[{index:X}sub{sub:X}]\nParameterName=Value {sub}\nObjectType=0x7\n"
        );
    }

    fn record(&mut self, index: u16, kind: u8, members: &[(u8, DataType, &str, &str)]) {
        self.head(index, kind);
        let highest = members.last().map_or(0, |member| member.0);
        let _ = writeln!(self.sections, "SubNumber={}", members.len() + 1);
        self.sub(index, 0);
        // Only a mapping entry can be written.
        let access = if index & 0xFA00 == 0x1200 {
            "rw"
        } else {
            "const"
        };
        self.entry(DataType::Unsigned8, access, false, &highest.to_string());
        for (sub, data_type, access, default) in members {
            self.sub(index, *sub);
            self.entry(*data_type, access, false, default);
        }
    }

    /// A manufacturer-specific object.
    fn object(&mut self, index: u16, choices: &mut Choices<'_>) {
        let kind = choices.below(4);
        if kind < 2 {
            self.head(index, 0x7);
            let made = value(Address::new(index, 0), None, choices);
            return self.push(made);
        }
        let count = 1 + choices.below(5);
        let is_array = kind == 3;
        self.head(index, if is_array { 0x8 } else { 0x9 });
        let common = is_array.then(|| value(Address::new(index, 1), None, choices));
        if let Some(made) = common.clone().filter(|_| choices.once_in(2)) {
            self.entry(made.data_type, made.access, made.mappable, &made.text);
            self.limits(&made);
            let _ = writeln!(self.sections, "CompactSubObj={count}");
            let members = (1..=count as u8).map(|sub| Made {
                address: Address::new(index, sub),
                ..made.clone()
            });
            return self.values.extend(members);
        }
        let _ = writeln!(self.sections, "SubNumber={}", count + 1);
        let (mut sub, mut members) = (0, Vec::new());
        for _ in 0..count {
            // A RECORD may have gaps.
            sub += 1 + if is_array {
                0
            } else {
                choices.pick(&[0, 0, 1, 30])
            };
            let data_type = common.as_ref().map(|made| made.data_type);
            members.push(value(Address::new(index, sub), data_type, choices));
        }
        self.sub(index, 0);
        self.entry(DataType::Unsigned8, "const", false, &sub.to_string());
        for made in members {
            self.sub(index, made.address.sub);
            self.push(made);
        }
    }

    fn push(&mut self, made: Made) {
        self.entry(made.data_type, made.access, made.mappable, &made.text);
        self.limits(&made);
        self.values.push(made);
    }

    fn limits(&mut self, made: &Made) {
        if let Some((low, high)) = made.limits {
            let _ = write!(self.sections, "LowLimit={low}\nHighLimit={high}\n");
        }
    }

    fn pdo(&mut self, number: u16, is_received: bool, choices: &mut Choices<'_>) {
        use DataType::{Unsigned8, Unsigned32};
        let fits = |(at, made): (usize, &Made)| {
            // A value outside its limits is not accepted from a PDO.
            let is_free = !is_received || made.limits.is_none();
            (made.fits_pdo(is_received) && is_free).then_some(at)
        };
        let all: Vec<usize> = self.values.iter().enumerate().filter_map(fits).collect();
        let size = |at: usize| self.values[at].data_type.size().unwrap_or(0);
        let (mut mapped, mut room) = (Vec::new(), 8);
        for _ in 0..1 + choices.below(8) {
            let Some(at) = all.get(choices.below(all.len().max(1))).copied() else {
                return;
            };
            // Two values in one place would have to be equal.
            if size(at) <= room && !mapped.contains(&at) {
                room -= size(at);
                mapped.push(at);
            }
        }
        let entries = mapped.iter().map(|at| {
            let Address { index, sub } = self.values[*at].address;
            format!("0x{index:04X}{sub:02X}{:02X}", size(*at) * 8)
        });
        let entries: Vec<String> = entries.collect();
        let members = (1..).zip(&entries);
        let members: Vec<_> = members
            .map(|(sub, entry)| (sub, Unsigned32, "rw", entry.as_str()))
            .collect();
        let (first, base, kind) = if is_received {
            (0x1400, 0x200, "255")
        } else {
            (0x1800, 0x180, "1")
        };
        let id = base + 0x100 * number;
        let cob_id = format!("$NODEID+0x{id:X}");
        let communication = [
            (1, Unsigned32, "rw", cob_id.as_str()),
            (2, Unsigned8, "rw", kind),
        ];
        self.record(first + number, 0x9, &communication);
        self.record(first + 0x200 + number, 0x9, &members);
        self.pdos.push(Pdo {
            id: id + u16::from(NODE),
            is_received,
            mapped,
        });
    }

    fn write(&mut self) {
        let count = |is_received| {
            let pdos = self.pdos.iter();
            pdos.filter(|pdo| pdo.is_received == is_received).count()
        };
        let mut text = format!(
            "[FileInfo]\nFileName=made.eds\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n\
             Description=made\nCreationTime=10:00AM\nCreationDate=11-21-2026\nCreatedBy=odkit\n\
             ModificationTime=10:00AM\nModificationDate=11-21-2026\nModifiedBy=odkit\n\n\
             [DeviceInfo]\nVendorName=odkit\nVendorNumber=0x5F\nProductName=Made\n\
             ProductNumber=0\nRevisionNumber=0\nOrderCode=M\nBaudRate_10=0\nBaudRate_20=0\n\
             BaudRate_50=0\nBaudRate_125=1\nBaudRate_250=1\nBaudRate_500=1\nBaudRate_800=0\n\
             BaudRate_1000=1\nSimpleBootUpMaster=0\nSimpleBootUpSlave=1\nGranularity=8\n\
             DynamicChannelsSupported=0\nCompactPDO=0\nGroupMessaging=0\nNrOfRXPDO={}\n\
             NrOfTXPDO={}\nLSS_Supported=0\n\n\
             [DummyUsage]\nDummy0001=0\nDummy0002=0\nDummy0003=0\nDummy0004=0\nDummy0005=0\n\
             Dummy0006=0\nDummy0007=0\n\n[Comments]\nLines=0\n",
            count(true),
            count(false)
        );
        for (name, list) in ["Mandatory", "Optional", "Manufacturer"]
            .iter()
            .zip(&mut self.lists)
        {
            list.sort_unstable();
            let _ = write!(text, "\n[{name}Objects]\nSupportedObjects={}\n", list.len());
            for (number, index) in (1..).zip(list) {
                let _ = writeln!(text, "{number}=0x{index:04X}");
            }
        }
        self.text = text + &self.sections;
    }
}
