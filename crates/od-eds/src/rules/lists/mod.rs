//! Rules whose codes begin with 02: contradictions between lists, sections and keys.

catalogue! {
    reader W0201
    reader W0202
    reader W0203
    reader W0204
    reader W0205
    reader W0206
    reader W0207
    reader E0208
    reader W0209
    e0210_no_object E0210
    reader I0211
    reader I0212
    reader W0213
    reader W0214
    reader W0215
    w0216_mandatory_key_missing W0216
    reader W0217
    reader W0218
    w0219_tools_sections W0219
    w0220_number_empty W0220
    i0240_file_sections_missing I0240
    w0241_comment_lines W0241
    reader W0242
    w0243_module_section_missing W0243
    w0244_list_count W0244
    w0245_segment_incomplete W0245
    w0246_segment_not_valid W0246
    w0247_dynamic_channels_supported W0247
    w0248_module_info W0248
    reader W0249
    i0251_dummy_entry_missing I0251
    reader W0252 (xdd)
    w0253_dummy_type W0253
    w0254_object_links W0254
    i0255_changed_before_created I0255
}

pub(crate) mod e0210_no_object;
pub(crate) mod i0240_file_sections_missing;
pub(crate) mod i0251_dummy_entry_missing;
pub(crate) mod i0255_changed_before_created;
pub(crate) mod reader;
pub(crate) mod w0216_mandatory_key_missing;
pub(crate) mod w0219_tools_sections;
pub(crate) mod w0220_number_empty;
pub(crate) mod w0241_comment_lines;
pub(crate) mod w0243_module_section_missing;
pub(crate) mod w0244_list_count;
pub(crate) mod w0245_segment_incomplete;
pub(crate) mod w0246_segment_not_valid;
pub(crate) mod w0247_dynamic_channels_supported;
pub(crate) mod w0248_module_info;
pub(crate) mod w0253_dummy_type;
pub(crate) mod w0254_object_links;
