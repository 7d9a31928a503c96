//! 05: PDOs. One file a rule.

mod cob_ids;
pub(crate) mod shared;

catalogue! {
    e0501 E0501
    e0502 E0502
    e0503 E0503
    e0504 E0504
    e0505 E0505
    w0506 W0506
    e0507 E0507
    w0508 W0508
    e0509 E0509
    e0510 E0510
    w0511 W0511
    e0512 E0512
    w0513 W0513
    i0515 I0515
    w0520 W0520
    w0521 W0521
    w0522 W0522
    w0524 W0524
    w0525 W0525
    w0526 W0526
    i0528 I0528
    w0529 W0529
    w0530 W0530
    i0531 I0531
    e0532 E0532
    e0533 E0533
    w0534 W0534
    w0535 W0535
    w0536 W0536
}

pub(crate) mod e0501;
pub(crate) mod e0502;
pub(crate) mod e0503;
pub(crate) mod e0504;
pub(crate) mod e0505;
pub(crate) mod e0507;
pub(crate) mod e0509;
pub(crate) mod e0510;
pub(crate) mod e0512;
pub(crate) mod e0532;
pub(crate) mod e0533;
pub(crate) mod i0515;
pub(crate) mod i0528;
pub(crate) mod i0531;
pub(crate) mod w0506;
pub(crate) mod w0508;
pub(crate) mod w0511;
pub(crate) mod w0513;
pub(crate) mod w0520;
pub(crate) mod w0521;
pub(crate) mod w0522;
pub(crate) mod w0524;
pub(crate) mod w0525;
pub(crate) mod w0526;
pub(crate) mod w0529;
pub(crate) mod w0530;
pub(crate) mod w0534;
pub(crate) mod w0535;
pub(crate) mod w0536;
