//! Device files of other fieldbuses, with the same endings or form as those of CANopen.

/// Names of other files, and texts that all must be in them.
const KINDS: [(&[&str], &str); 8] = [
    (
        &["[File]", "[Device]", "VendCode"],
        "an EDS of EtherNet/IP or DeviceNet (ODVA)",
    ),
    (&["<EtherCATInfo"], "an ESI file of EtherCAT"),
    (&["ethernet-powerlink.org"], "an XDD of Ethernet POWERLINK"),
    (&["<ISO15745Profile", "GSDML"], "a GSDML file of PROFINET"),
    (&["#Profibus_DP"], "a GSD file of PROFIBUS"),
    (&["<IODevice"], "an IODD file of IO-Link"),
    (&["VERSION", "BS_:", "BU_:"], "a DBC file of CAN messages"),
    (&["<PLCopen"], "a PLCopen project"),
];
/// Number of bytes in which a file must show its kind.
const HEAD: usize = 8192;

/// Returns what a text is if it is a device file of another fieldbus: `an ESI file of EtherCAT`.
///
/// ```
/// let text = "<?xml version=\"1.0\"?>\n<EtherCATInfo Version=\"1.2\"></EtherCATInfo>\n";
/// assert_eq!(od_eds::foreign(text), Some("an ESI file of EtherCAT"));
/// assert_eq!(od_eds::foreign("[FileInfo]\nFileName=my.eds\n"), None);
/// ```
pub fn foreign(text: &str) -> Option<&'static str> {
    let mut end = text.len().min(HEAD);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let head = &text[..end];
    // A file of CANopen may quote another one in a comment or a name.
    if head.contains("[DeviceInfo]") || head.contains("www.canopen.org/xml") {
        return None;
    }
    let is_one = |(texts, _): &&(&[&str], _)| texts.iter().all(|text| head.contains(text));
    KINDS.iter().find(is_one).map(|(_, name)| *name)
}
