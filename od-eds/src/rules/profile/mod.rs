//! 09: device profiles. One file per rule.

pub(crate) mod shared;
pub(crate) mod table;

catalogue! {
    w0901 W0901
    w0902 W0902
    w0903 W0903
    w0904 W0904
    w0905 W0905
    w0906 W0906
    e0907 E0907
    e0908 E0908
    w0909 W0909
    w0910 W0910
    w0911 W0911
    w0912 W0912
    w0913 W0913
    w0914 W0914
    w0915 W0915
    e0916 E0916
    w0917 W0917
    w0918 W0918
    w0950 W0950
    w0951 W0951
    w0952 W0952
    w0953 W0953
    w0954 W0954
    w0955 W0955
    w0956 W0956
    w0957 W0957
    w0958 W0958
    w0959 W0959
    w0960 W0960
    e0961 E0961
    w0962 W0962
    w0963 W0963
}

pub(crate) mod e0907;
pub(crate) mod e0908;
pub(crate) mod e0916;
pub(crate) mod e0961;
pub(crate) mod w0901;
pub(crate) mod w0902;
pub(crate) mod w0903;
pub(crate) mod w0904;
pub(crate) mod w0905;
pub(crate) mod w0906;
pub(crate) mod w0909;
pub(crate) mod w0910;
pub(crate) mod w0911;
pub(crate) mod w0912;
pub(crate) mod w0913;
pub(crate) mod w0914;
pub(crate) mod w0915;
pub(crate) mod w0917;
pub(crate) mod w0918;
pub(crate) mod w0950;
pub(crate) mod w0951;
pub(crate) mod w0952;
pub(crate) mod w0953;
pub(crate) mod w0954;
pub(crate) mod w0955;
pub(crate) mod w0956;
pub(crate) mod w0957;
pub(crate) mod w0958;
pub(crate) mod w0959;
pub(crate) mod w0960;
pub(crate) mod w0962;
pub(crate) mod w0963;
