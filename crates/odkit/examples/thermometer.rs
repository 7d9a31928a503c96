//! A thermometer with a heater. Each line of the input is the temperature (°C) of one second; frames are printed.

use odkit::storage::{File, OpenError};
use odkit::{AbortCode, Address, Application, Context, Emcy, Instant, Node, NodeId};
use thermometer::{HEATER, LIMIT, TEMPERATURE, TENTHS};

odkit::object_dictionary! {
    pub(crate) mod thermometer {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1010 { code = array; name = "Store parameters" }
        add 0x1010sub1 { name = "Save all parameters"; type = u32; access = rw; default = 1 }
        add 0x1011 { code = array; name = "Restore default parameters" }
        add 0x1011sub1 { name = "Restore all default parameters"; type = u32; access = rw; default = 1 }
        add 0x1014 { name = "COB-ID EMCY"; type = u32; default = $NODEID + 0x80 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1400 { code = record; name = "RPDO communication parameter 1" }
        add 0x1400sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x200 }
        add 0x1400sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
        add 0x1600 { code = record; name = "RPDO mapping parameter 1" }
        add 0x1600sub1 { name = "Heater"; type = u32; access = rw; default = 0x2002_0008 }
        add 0x1800 { code = record; name = "TPDO communication parameter 1" }
        add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
        add 0x1A00 { code = record; name = "TPDO mapping parameter 1" }
        add 0x1A00sub1 { name = "Temperature"; type = u32; access = rw; default = 0x2000_0020 }
        add 0x1A00sub2 { name = "Tenths"; type = u32; access = rw; default = 0x2001_0010 }
        add 0x2000 { name = "Temperature"; type = f32; mappable = true; default = 20.0 }
        add 0x2001 { name = "Tenths"; type = i16; mappable = true; default = 200 }
        add 0x2002 { name = "Heater"; type = u8; access = rww; mappable = true; high = 1; save = none }
        add 0x2003 { name = "Limit"; type = f32; access = rw; default = 80.0 }
    }
}

pub(crate) struct Heater;
impl Application for Heater {
    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        match address {
            HEATER::ADDRESS if cx.store.get(TEMPERATURE) > cx.store.get(LIMIT) => {
                Err(AbortCode::DeviceState)
            }
            LIMIT::ADDRESS if !LIMIT.decode(value).is_finite() => Err(AbortCode::ValueRange),
            _ => Ok(()),
        }
    }
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let celsius = cx.store.get(TEMPERATURE);
        cx.store.set(TENTHS, (celsius * 10.0) as i16);
        if celsius > cx.store.get(LIMIT) {
            cx.store.set(HEATER, 0);
            cx.signals.raise(Emcy::new(0x4200, 0x09));
        } else {
            cx.signals.clear(0x4200, [0; 5]);
        }
        None
    }
}

/// A node that is still switched off; its saved values are in a file.
pub(crate) fn node(path: &str) -> Result<thermometer::Node<Heater, File>, OpenError> {
    let file = File::of(path, &thermometer::DICTIONARY)?;
    Ok(Node::new(thermometer::Device, NodeId::ONE, Heater, file))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut node = node("thermometer.eeprom")?;
    node.power_on(Instant::ZERO);
    for (second, line) in (1..).zip(std::io::stdin().lines()) {
        let now = Instant::from_millis(1000 * second);
        node.set(now, TEMPERATURE, line?.parse()?);
        while let Some(frame) = node.poll_transmit(now) {
            println!("{frame}");
        }
    }
    Ok(())
}
