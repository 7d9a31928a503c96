//! 06: mandatory and standard objects, identity, `[DeviceInfo]`. One file per rule.

mod shared;
pub(crate) mod table;

catalogue! {
    e0601 E0601
    e0602 E0602
    e0603 E0603
    e0604 E0604
    e0605 E0605
    e0606 E0606
    w0607 W0607
    w0608 W0608
    w0609 W0609
    i0610 I0610
    i0611 I0611
    w0630 W0630
    w0631 W0631
    w0632 W0632
    w0633 W0633
    w0634 W0634
    w0635 W0635
    w0637 W0637
    w0638 W0638
    w0639 W0639
    w0642 W0642
    e0643 E0643
    w0644 W0644
    e0646 E0646
    w0647 W0647
    w0648 W0648
    w0649 W0649
    e0650 E0650
    w0651 W0651
    w0653 W0653
    w0655 W0655
    w0656 W0656
    i0657 I0657
}

pub(crate) mod e0601;
pub(crate) mod e0602;
pub(crate) mod e0603;
pub(crate) mod e0604;
pub(crate) mod e0605;
pub(crate) mod e0606;
pub(crate) mod e0643;
pub(crate) mod e0646;
pub(crate) mod e0650;
pub(crate) mod i0610;
pub(crate) mod i0611;
pub(crate) mod i0657;
pub(crate) mod w0607;
pub(crate) mod w0608;
pub(crate) mod w0609;
pub(crate) mod w0630;
pub(crate) mod w0631;
pub(crate) mod w0632;
pub(crate) mod w0633;
pub(crate) mod w0634;
pub(crate) mod w0635;
pub(crate) mod w0637;
pub(crate) mod w0638;
pub(crate) mod w0639;
pub(crate) mod w0642;
pub(crate) mod w0644;
pub(crate) mod w0647;
pub(crate) mod w0648;
pub(crate) mod w0649;
pub(crate) mod w0651;
pub(crate) mod w0653;
pub(crate) mod w0655;
pub(crate) mod w0656;
