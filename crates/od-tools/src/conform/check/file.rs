//! Checks the EDS itself, and whether it describes the node.

use od_eds::{Document, Eds as Words, say};
use od_model::{Address, values};

use crate::conform::dut::Dut;
use crate::conform::eds::Eds;
use crate::conform::end::{Checked, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::number;

pub(super) fn no_errors(dut: &mut Dut<'_>) -> Checked {
    let errors: Vec<_> = dut
        .eds
        .findings
        .iter()
        .filter(|finding| finding.is_error())
        .collect();
    match errors.first() {
        None => Ok(()),
        Some(first) => {
            let place = first
                .span()
                .map_or(String::new(), |span| format!(" in line {}", span.line));
            let why = say(first, &Words).message;
            fail(
                "an EDS without errors",
                match errors.len() {
                    1 => format!("{}{place}: {why}", first.code()),
                    number => format!(
                        "{number} errors, the first {}{place}: {why}; `odkit check` shows them",
                        first.code()
                    ),
                },
            )
        }
    }
}

/// 1000h, 1001h and 1018h:01 exist in the EDS and in the node.
pub(super) fn mandatory(dut: &mut Dut<'_>) -> Checked {
    for (index, sub) in [(0x1000, 0), (0x1001, 0), (0x1018, 0), (0x1018, 1)] {
        let address = Address::new(index, sub);
        let has = dut.eds.entry(index, sub).is_some();
        ensure(has, format!("{address} in the EDS"), "it does not have it")?;
        dut.read(address)?;
    }
    Ok(())
}

pub(super) fn device_type(dut: &mut Dut<'_>) -> Checked {
    same(dut, 0x1000, 0)
}

/// Compares vendor-ID, product code and revision number; the serial number differs between devices.
pub(super) fn identity(dut: &mut Dut<'_>) -> Checked {
    for sub in 1..=3 {
        same(dut, 0x1018, sub)?;
    }
    Ok(())
}

fn same(dut: &mut Dut<'_>, index: u16, sub: u8) -> Checked {
    let Some(entry) = dut.eds.entry(index, sub) else {
        return Ok(());
    };
    let Some(wanted) = dut.eds.default(&entry, dut.node) else {
        return Ok(());
    };
    let is = dut.read(entry.address)?;
    ensure(
        is == wanted,
        format!("{} = {}", entry.address, values::hex(&wanted)),
        format!("{} was read", values::hex(&is)),
    )
}

/// `[DeviceInfo]` and 1018h name the same vendor and product.
pub(super) fn device_info(dut: &mut Dut<'_>) -> Checked {
    let mut any = false;
    for (key, sub) in [("VendorNumber", 1), ("ProductNumber", 2)] {
        let Some(wanted) = dut.eds.info(key).filter(|wanted| *wanted != 0) else {
            continue;
        };
        if dut.eds.entry(0x1018, sub).is_none() {
            continue;
        }
        any = true;
        let is = number(&dut.read(Address::new(0x1018, sub))?);
        ensure(
            i128::from(is) == wanted,
            format!("1018h:{sub:02} = {wanted:X}h, the {key} of the EDS"),
            format!("{is:X}h was read"),
        )?;
    }
    at_least_one(any, "[DeviceInfo] has no VendorNumber and ProductNumber")
}

/// The file in 1021h is an EDS with the identity of the node, if 1022h says that it is a plain text.
pub(super) fn stored(dut: &mut Dut<'_>) -> Checked {
    let format = match dut.upload(Address::new(0x1022, 0))? {
        Ok(format) => number(&format),
        // Without 1022h the format is 0.
        Err(_) => 0,
    };
    if format != 0 {
        return lacks(format!(
            "the format of the stored file is {format:X}h (1022h)"
        ));
    }
    let text = match dut.upload(Address::new(0x1021, 0))? {
        Ok(bytes) if !bytes.is_empty() => Document::new(bytes).text().to_owned(),
        _ => return lacks("the node stores no file in 1021h"),
    };
    let stored = Eds::read(&text);
    ensure(
        !stored.description.objects.is_empty(),
        "an EDS in 1021h, as 1022h is 0",
        format!("a text of {} bytes that defines no object came", text.len()),
    )?;
    for (key, sub) in [
        ("VendorNumber", 1),
        ("ProductNumber", 2),
        ("RevisionNumber", 3),
    ] {
        let address = Address::new(0x1018, sub);
        let Some(wanted) = stored.info(key).filter(|wanted| *wanted != 0) else {
            continue;
        };
        if let Ok(bytes) = dut.upload(address)? {
            let is = number(&bytes);
            let done = ensure(
                i128::from(is) == wanted,
                format!("{key}={is} in the EDS in 1021h, as in {address}"),
                format!("it is {wanted}"),
            );
            dut.fault(done)?;
        }
    }
    Ok(())
}

/// The numbers of PDOs in `[DeviceInfo]` are those of the EDS.
pub(super) fn pdo_count(dut: &mut Dut<'_>) -> Checked {
    for (key, base) in [("NrOfRXPDO", 0x1400), ("NrOfTXPDO", 0x1800)] {
        let is = dut.eds.pdos(base).len();
        if let Some(wanted) = dut.eds.info(key) {
            ensure(
                wanted == is as i128,
                format!("{key}={is}, the PDOs of the EDS"),
                format!("it is {wanted}"),
            )?;
        }
    }
    Ok(())
}

/// Granularity 0 means that no mapping can be changed.
pub(super) fn granularity(dut: &mut Dut<'_>) -> Checked {
    let mut entries = dut.eds.dictionary().entries();
    let is_mapping = |index| matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
    let variable = entries.find(|entry| {
        is_mapping(entry.address.index) && entry.address.sub > 0 && entry.access.writable()
    });
    let Some(granularity) = dut.eds.info("Granularity") else {
        return lacks("[DeviceInfo] has no Granularity");
    };
    match variable.filter(|_| granularity == 0) {
        Some(entry) => fail(
            format!(
                "Granularity of 1 to 64, as {} can be written",
                entry.address
            ),
            "it is 0, which means that no mapping can be changed",
        ),
        None => Ok(()),
    }
}
