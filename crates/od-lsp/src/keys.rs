//! Descriptions of the keys of CiA 306-1.

use od_eds::network::keys::{Keys, OF_LIST, OF_LISTED};

/// Explains a key of an object's section.
pub(crate) fn of_object(key: &str) -> Option<&'static str> {
    Some(match key.to_ascii_lowercase().as_str() {
        "parametername" => "Name of the object, up to 241 characters.",
        "objecttype" => {
            "Object code: `0x7` VAR (assumed if the key is missing), `0x8` ARRAY, `0x9` RECORD, `0x2` DOMAIN."
        }
        "subnumber" => "Number of sub-objects, sub-index 0 included.",
        "datatype" => {
            "Data type of the value: the index of its definition, such as `0x0007` for UNSIGNED32."
        }
        "lowlimit" => "Smallest valid value; empty for the limit of the data type.",
        "highlimit" => "Largest valid value; empty for the limit of the data type.",
        "accesstype" => "Access from the bus: `ro`, `wo`, `rw`, `rwr`, `rww` or `const`.",
        "defaultvalue" => {
            "Value after a reset without saved values; `$NODEID+0x180` depends on the node ID."
        }
        "pdomapping" => "`1` if the value can be mapped into a PDO, else `0`.",
        "objflags" => {
            "Bit 0: tools do not write the object on a download. Bit 1: tools do not read it on a scan."
        }
        "compactsubobj" => {
            "Number of sub-objects that have no section of their own, because they are alike."
        }
        "parametervalue" => "Value of this node: a tool writes it to the device.",
        "denotation" => "Name of the value in the application of this node.",
        "uploadfile" => "File into which a tool writes an upload of the value.",
        "downloadfile" => "File from which a tool reads the value for a download.",
        "paramrefd" => "Reference to the parameter in a project.",
        _ => return None,
    })
}

/// Explains a key of another section.
pub(crate) fn of_section(section: &str, key: &str) -> Option<&'static str> {
    let (section, key) = (section.to_ascii_lowercase(), key.to_ascii_lowercase());
    Some(match (section.as_str(), key.as_str()) {
        ("fileinfo", "filename") => "Name of the file.",
        ("fileinfo", "fileversion") => "Version of the file, 0 to 255.",
        ("fileinfo", "filerevision") => "Revision of the file, 0 to 255.",
        ("fileinfo", "edsversion") => {
            "Version of CiA 306 that the file follows: `4.0`, `4.1` or `4.2`."
        }
        ("fileinfo", "lasteds") => "Name of the EDS that the DCF was made from.",
        ("fileinfo", "description") => "Description of the file, up to 243 characters.",
        ("fileinfo", "creationtime" | "modificationtime") => "Time of day as `09:30AM`.",
        ("fileinfo", "creationdate" | "modificationdate") => {
            "Date as `07-14-2026`: month, day, year."
        }
        ("fileinfo", "createdby" | "modifiedby") => "Name of a person or a tool.",
        ("deviceinfo", "vendorname") => "Name of the manufacturer.",
        ("deviceinfo", "vendornumber") => "Vendor-ID, as in 1018h:01.",
        ("deviceinfo", "productname") => "Name of the product.",
        ("deviceinfo", "productnumber") => "Product code, as in 1018h:02.",
        ("deviceinfo", "revisionnumber") => "Revision number, as in 1018h:03.",
        ("deviceinfo", "ordercode") => "Order code of the product.",
        ("deviceinfo", "simplebootupmaster") => "`1` if the device can be a simple boot-up master.",
        ("deviceinfo", "simplebootupslave") => "`1` if the device can be a simple boot-up slave.",
        ("deviceinfo", "granularity") => {
            "Granularity of PDO mapping in bits: 1 to 64; 0 if the mapping is fixed."
        }
        ("deviceinfo", "dynamicchannelssupported") => {
            "Dynamic channels of a programmable device (CiA 302): 0 if not supported."
        }
        ("deviceinfo", "groupmessaging") => "`1` if multiplexed PDOs are supported.",
        ("deviceinfo", "nrofrxpdo") => "Number of RPDOs.",
        ("deviceinfo", "nroftxpdo") => "Number of TPDOs.",
        ("deviceinfo", "lss_supported") => "`1` if the device is an LSS slave (CiA 305).",
        ("deviceinfo", "compactpdo") => {
            "Bits of the sub-objects that PDO parameters without a section have."
        }
        ("deviceinfo", "ng_slave") => "`1` if the device supports node guarding as a slave.",
        ("deviceinfo", key) if key.starts_with("baudrate_") => {
            "`1` if the device supports this bit rate in kbit/s."
        }
        ("dummyusage", _) => "`1` if RPDOs may map this data type as a dummy entry.",
        ("comments", "lines") => "Number of comment lines.",
        ("devicecomissioning" | "devicecommissioning", key) => match key {
            "nodeid" => "Node ID, 1 to 127.",
            "nodename" => "Name of the node.",
            "baudrate" => "Bit rate in kbit/s.",
            "netnumber" => "Number of the network.",
            "networkname" => "Name of the network.",
            "canopenmanager" => "`1` if the node is the CANopen manager.",
            "lss_serialnumber" => "Serial number of the node for LSS (CiA 305).",
            _ => return None,
        },
        ("mandatoryobjects" | "optionalobjects" | "manufacturerobjects", "supportedobjects") => {
            "Number of objects in this list."
        }
        (section, key) if section.starts_with("topology") => return of_node_list(key),
        _ => return None,
    })
}

/// Explains a key of a node list, in lower case.
fn of_node_list(key: &str) -> Option<&'static str> {
    let end = key.strip_prefix("node").unwrap_or_default();
    let end = end.trim_start_matches(|c: char| c.is_ascii_digit());
    let meaning = |keys: Keys, name: &str| {
        let own = keys.iter().find(|(own, _)| own.eq_ignore_ascii_case(name));
        own.map(|(_, says)| *says)
    };
    meaning(OF_LIST, key).or_else(|| meaning(OF_LISTED, end))
}

/// Explains a section.
pub(crate) fn section(name: &str) -> Option<&'static str> {
    Some(match name.to_ascii_lowercase().as_str() {
        "fileinfo" => "The file itself: its name, version, author and dates (CiA 306-1).",
        "deviceinfo" => "The device: identity, bit rates and general features (CiA 306-1).",
        "dummyusage" => "The data types that RPDOs may map as dummy entries (CiA 306-1).",
        "comments" => "Comments of the author (CiA 306-1).",
        "mandatoryobjects" => {
            "List of the objects that every device has: 1000h, 1001h, 1018h (CiA 306-1)."
        }
        "optionalobjects" => {
            "List of the objects 1002h to 1FFFh and 6000h to FFFFh, without the mandatory ones (CiA 306-1)."
        }
        "manufacturerobjects" => "List of the objects 2000h to 5FFFh (CiA 306-1).",
        "devicecomissioning" | "devicecommissioning" => {
            "The node and its network, in a DCF (CiA 306-1)."
        }
        "supportedmodules" => "Number of modules that can be plugged in (CiA 306-1).",
        "connectedmodules" => "The modules that are plugged in, in a DCF (CiA 306-1).",
        "dynamicchannels" => "Ranges of objects for network variables (CiA 302, CiA 306-1).",
        "tools" => "Programs for this device (CiA 306-1).",
        name if name.starts_with("topology") => {
            "The nodes of a network, and their DCFs (CiA 306-3)."
        }
        _ => return None,
    })
}
