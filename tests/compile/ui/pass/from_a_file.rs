//! A file beside this one, edited, with two variants and lints that deny everything.
#![deny(warnings, missing_docs, unreachable_pub)]

use odkit::object_dictionary;

object_dictionary! {
    /// A device.
    #[allow(clippy::pedantic)]
    mod device {
        profile = cia301;
        rename 0x2300 = RESTART;
        modify 0x1018sub1 { default = 0x60 }
        eds = "../eds/sound.eds";
        warnings = off;
        variant slow {
            modify 0x2300 { default = 9; save = none };
        }
        /// Without it.
        #[cfg(true)]
        variant none {
            remove 0x2300;
        }
    }
}

#[test]
fn compiles() {
    let _ = (device::RESTART, device::slow::RESTART);
    assert!(device::none::DICTIONARY.object(0x2300).is_none());
}
