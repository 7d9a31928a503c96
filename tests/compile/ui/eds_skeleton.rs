//! Valid parts exist in spite of the error: using them is not a second error.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/skeleton.eds";

        variant fast {
            modify 0x2301 { default = 9 }
        }
    }
}

fn main() {
    let _ = (device::RESET, device::SPEED, device::fast::SPEED);
    let _ = [0; device::STORE_LEN];
    let _ = device::DICTIONARY.objects();
}
