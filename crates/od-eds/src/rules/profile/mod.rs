//! Rules whose codes begin with 09: device profiles.

pub(crate) mod shared;

catalogue! {
    missing W0901
    missing W0902
    missing W0903
    missing W0904
    overview W0905
    overview W0906
    overview E0907
    missing E0908
    w0909_drive_mode_object_missing W0909
    w0910_drive_start_mode W0910
    w0911_lower_above_upper W0911
    w0912_io_channels_missing W0912
    w0913_io_channels_not_declared W0913
    w0914_value_reserved W0914
    w0915_divisor_0 W0915
    e0916_drive_sub_object_missing E0916
    w0917_drive_value_outside_limits W0917
    w0918_drive_mode_not_displayed W0918
    w0919_drive_mode_fixed W0919
    w0920_scaling_points_equal W0920
    w0921_chosen_object_missing W0921
    w0922_profile_not_declared W0922
    w0923_homing_method_not_supported W0923
    overview W0950
    overview W0951
    w0952_encoder_range W0952
    w0953_position_not_mappable W0953
    w0954_operating_status W0954
    w0955_preset_outside_range W0955
    w0956_units_above_resolution W0956
    w0957_device_type_and_revolutions W0957
    w0958_cyclic_timer W0958
    w0959_alarm_not_supported W0959
    w0960_cams_incomplete W0960
    overview E0961
    w0962_encoder_type_unknown W0962
    w0963_position_not_mapped W0963
    w0964_serial_number_differs W0964
}

pub(crate) mod e0916_drive_sub_object_missing;
pub(crate) mod missing;
pub(crate) mod overview;
pub(crate) mod w0909_drive_mode_object_missing;
pub(crate) mod w0910_drive_start_mode;
pub(crate) mod w0911_lower_above_upper;
pub(crate) mod w0912_io_channels_missing;
pub(crate) mod w0913_io_channels_not_declared;
pub(crate) mod w0914_value_reserved;
pub(crate) mod w0915_divisor_0;
pub(crate) mod w0917_drive_value_outside_limits;
pub(crate) mod w0918_drive_mode_not_displayed;
pub(crate) mod w0919_drive_mode_fixed;
pub(crate) mod w0920_scaling_points_equal;
pub(crate) mod w0921_chosen_object_missing;
pub(crate) mod w0922_profile_not_declared;
pub(crate) mod w0923_homing_method_not_supported;
pub(crate) mod w0952_encoder_range;
pub(crate) mod w0953_position_not_mappable;
pub(crate) mod w0954_operating_status;
pub(crate) mod w0955_preset_outside_range;
pub(crate) mod w0956_units_above_resolution;
pub(crate) mod w0957_device_type_and_revolutions;
pub(crate) mod w0958_cyclic_timer;
pub(crate) mod w0959_alarm_not_supported;
pub(crate) mod w0960_cams_incomplete;
pub(crate) mod w0962_encoder_type_unknown;
pub(crate) mod w0963_position_not_mapped;
pub(crate) mod w0964_serial_number_differs;
