//! `without` and `behaves`: a node has code for the services of its device only, and the profile that the
//! compiler knows is used.

use odkit::storage::NoStorage;
use odkit::{Frame, Instant, NoApplication, Node, NodeId, PdoProfile, Profile, SdoProfile};

static PROFILE: Profile = Profile {
    sdo: SdoProfile {
        min_dlc: 4,
        ..Profile::CIA301.sdo
    },
    pdo: PdoProfile {
        event_on_change: false,
        ..Profile::CIA301.pdo
    },
    ..Profile::CIA301
};

macro_rules! device {
    ($name:ident, $($without:tt)*) => {
        odkit::object_dictionary! {
            mod $name {
                $($without)*
                add 0x1000 { name = "Device type"; type = u32; default = 0 }
                add 0x1001 { name = "Error register"; type = u8 }
                add 0x1018 { code = record; name = "Identity object" }
                add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 1 }
                add 0x2000 { name = "Text"; type = str; access = rw; default = "more than four" }
                add 0x2001 { name = "Number"; type = u32; access = rw; default = 7 }

                variant small {
                    remove 0x2001;
                }
            }
        }
    };
}

device!(full,);
device!(lean, without lss, segmented, block, events; behaves = PROFILE;);

device!(few, errors = 2;);

type Small<D> = Node<D, NoApplication, NoStorage>;

#[test]
fn a_service_that_is_off_uses_no_ram() {
    use core::mem::size_of;
    // An error takes 8 bytes while it is active, and 10 until the node has processed it.
    assert!(size_of::<Small<full::Device>>() - size_of::<Small<few::Device>>() >= 30 * 18);
    assert!(size_of::<Small<full::Device>>() - size_of::<Small<lean::Device>>() > 150);
}

/// The responses of a node to each request, and whether it had an event for its host.
macro_rules! answers {
    ($module:path, $requests:expr) => {{
        use $module as device;
        let mut node = Node::new(device::Device, NodeId::ONE, NoApplication, NoStorage);
        let now = Instant::ZERO;
        node.power_on(now);
        while node.poll_transmit(now).is_some() {}
        let mut found = Vec::new();
        for request in $requests {
            let request = Frame::new(odkit::CanId::standard(0x601), request).unwrap();
            node.handle_frame(now, &request);
            let answer = node.poll_transmit(now);
            found.push(answer.map_or(String::from("nothing"), |frame| frame.to_string()));
        }
        (found, node.poll_event().is_some())
    }};
}

const REQUESTS: [&[u8]; 5] = [
    &[0x40, 0x00, 0x20, 0, 0, 0, 0, 0],
    &[0xA4, 0x00, 0x20, 0, 127, 0, 0, 0],
    &[0x21, 0x00, 0x20, 0, 9, 0, 0, 0],
    &[0x40, 0x00, 0x10, 0, 0, 0, 0, 0],
    &[0x40, 0x00, 0x10, 0],
];

#[test]
fn a_service_that_is_off_responds_like_a_missing_one() {
    let (full, has_events) = answers!(full, REQUESTS);
    assert_eq!(full[0], "581#410020000E000000");
    assert_eq!(full[1], "581#C60020000E000000");
    assert_eq!(full[2], "581#6000200000000000");
    assert_eq!(full[3..], ["581#4300100000000000", "nothing"]);
    assert!(has_events);

    let (lean, has_events) = answers!(lean, REQUESTS);
    assert_eq!(lean[0], "581#8000200000000106", "06010000h");
    assert_eq!(lean[1], "581#8000200001000405", "05040001h");
    assert_eq!(lean[2], "581#8000200001000405", "05040001h");
    // `behaves = PROFILE` accepts four bytes.
    assert_eq!(lean[3..], ["581#4300100000000000", "581#4300100000000000"]);
    assert!(!has_events);
    assert_eq!(answers!(lean::small, REQUESTS).0, lean);
}

odkit::object_dictionary! {
    mod rich {
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1005 { name = "COB-ID SYNC"; type = u32; access = rw; default = 0x4000_0080 }
        add 0x1006 { name = "SYNC period"; type = u32; access = rw; default = 5000 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 1 }
        add 0x1201 { code = record; name = "SDO server 2" }
        add 0x1201sub1 { name = "COB-ID request"; type = u32; default = 0x680 }
        add 0x1201sub2 { name = "COB-ID response"; type = u32; default = 0x6C0 }
    }
}

#[test]
fn a_node_has_the_servers_and_the_sync_producer_of_its_dictionary() {
    let mut node = Node::new(rich::Device, NodeId::ONE, NoApplication, NoStorage);
    node.power_on(Instant::ZERO);
    while node.poll_transmit(Instant::ZERO).is_some() {}
    let request = Frame::standard(0x680, &[0x40, 0x18, 0x10, 1, 0, 0, 0, 0]);
    node.handle_frame(Instant::ZERO, &request);
    let answer = node.poll_transmit(Instant::ZERO).unwrap();
    assert_eq!(answer.to_string(), "6C0#4318100101000000");
    let at = node.poll_timeout().unwrap();
    assert_eq!(at, Instant::from_millis(5));
    node.handle_timeout(at);
    let sync = node.poll_transmit(at).unwrap();
    assert_eq!(sync, Frame::standard(0x80, &[]));
}
