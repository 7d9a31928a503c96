//! 04: types, values, limits. One file a rule.

pub(crate) mod shared;

catalogue! {
    e0401 E0401
    e0402 E0402
    e0403 E0403
    w0404 W0404
    e0405 E0405
    w0406 W0406
    w0407 W0407
    i0408 I0408
    w0409 W0409
    i0410 I0410
    i0411 I0411
    e0412 E0412
    e0413 E0413
    e0414 E0414
    e0415 E0415
    w0416 W0416
    e0417 E0417
    e0418 E0418
    w0419 W0419
    w0420 W0420
    w0421 W0421
    w0422 W0422
    w0423 W0423
    w0424 W0424
    i0425 I0425
    w0426 W0426
    w0427 W0427
    w0445 W0445
    w0446 W0446
    i0447 I0447
    i0450 I0450
    w0452 W0452
    w0453 W0453
    w0454 W0454
}

pub(crate) mod e0401;
pub(crate) mod e0402;
pub(crate) mod e0403;
pub(crate) mod e0405;
pub(crate) mod e0412;
pub(crate) mod e0413;
pub(crate) mod e0414;
pub(crate) mod e0415;
pub(crate) mod e0417;
pub(crate) mod e0418;
pub(crate) mod i0408;
pub(crate) mod i0410;
pub(crate) mod i0411;
pub(crate) mod i0425;
pub(crate) mod i0447;
pub(crate) mod i0450;
pub(crate) mod w0404;
pub(crate) mod w0406;
pub(crate) mod w0407;
pub(crate) mod w0409;
pub(crate) mod w0416;
pub(crate) mod w0419;
pub(crate) mod w0420;
pub(crate) mod w0421;
pub(crate) mod w0422;
pub(crate) mod w0423;
pub(crate) mod w0424;
pub(crate) mod w0426;
pub(crate) mod w0427;
pub(crate) mod w0445;
pub(crate) mod w0446;
pub(crate) mod w0452;
pub(crate) mod w0453;
pub(crate) mod w0454;
