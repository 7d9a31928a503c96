//! A file with five errors that its owner may not change, corrected in the call.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../eds/broken.eds";
        warnings = off;
        modify 0x2300 { default = 1 }
        modify 0x2301 { low = none; high = none }
        modify 0x2302 { type = u16 }
        modify 0x2303 { access = rw }
        remove 0x2304;
    }
}

#[test]
fn compiles() {
    let _ = (device::RESET, device::SPEED, device::TORQUE, device::POWER);
}
