//! 01: text and INI structure. One file a rule.

catalogue! {
    w0101_unknown_line W0101
    w0102_no_key W0102
    w0103_no_closing_bracket W0103
    w0104_text_after_header W0104
    w0105_key_before_section W0105
    w0106_duplicate_section W0106
    w0107_duplicate_key W0107
    w0108_colon W0108
    w0109_comment_after_value W0109
    w0110_header_without_name W0110
    i0111_not_ascii I0111
    w0112_encoding W0112
    e0113_xml_not_well_formed E0113 (xdd)
    e0114_xdd_index_not_valid E0114 (xdd)
    e0115_xdd_parameter_missing E0115 (xdd)
    w0116_too_many_findings W0116 (example)
    e0117_duplicate_key_differs E0117
    e0118_merge_conflict E0118
}

pub(crate) mod e0113_xml_not_well_formed;
pub(crate) mod e0114_xdd_index_not_valid;
pub(crate) mod e0115_xdd_parameter_missing;
pub(crate) mod e0117_duplicate_key_differs;
pub(crate) mod e0118_merge_conflict;
pub(crate) mod i0111_not_ascii;
pub(crate) mod w0101_unknown_line;
pub(crate) mod w0102_no_key;
pub(crate) mod w0103_no_closing_bracket;
pub(crate) mod w0104_text_after_header;
pub(crate) mod w0105_key_before_section;
pub(crate) mod w0106_duplicate_section;
pub(crate) mod w0107_duplicate_key;
pub(crate) mod w0108_colon;
pub(crate) mod w0109_comment_after_value;
pub(crate) mod w0110_header_without_name;
pub(crate) mod w0112_encoding;
pub(crate) mod w0116_too_many_findings;
