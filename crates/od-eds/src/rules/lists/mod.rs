//! 02: lists, sections and keys against each other. One file per rule.

catalogue! {
    w0201_section_missing W0201
    w0202_object_not_listed W0202
    w0203_lists_missing W0203
    w0204_supported_objects_count W0204
    w0205_list_entry_not_valid W0205
    w0206_wrong_list W0206
    w0207_listed_twice W0207
    e0208_sub_index_without_object E0208
    w0209_compact_without_key W0209
    e0210_no_object E0210
    i0211_unknown_section I0211
    i0212_section_name_spelling I0212
    w0213_section_misspelled W0213
    w0214_number_twice W0214
    w0215_module_list W0215
    w0216_mandatory_key_missing W0216
    w0217_dcf_key_in_eds W0217
    w0218_list_entry_spelling W0218
    w0219_tools_sections W0219
    i0240_file_sections_missing I0240
    w0241_comment_lines W0241
    w0242_list_numbering W0242
    w0243_module_section_missing W0243
    w0244_list_count W0244
    w0245_segment_incomplete W0245
    w0246_segment_not_valid W0246
    w0247_dynamic_channels_supported W0247
    w0248_module_info W0248
    w0249_extended_object_missing W0249
    i0251_dummy_entry_missing I0251
    w0252_bit_rate_unknown W0252
    w0253_dummy_type W0253
    w0254_object_links W0254
}

pub(crate) mod e0208_sub_index_without_object;
pub(crate) mod e0210_no_object;
pub(crate) mod i0211_unknown_section;
pub(crate) mod i0212_section_name_spelling;
pub(crate) mod i0240_file_sections_missing;
pub(crate) mod i0251_dummy_entry_missing;
pub(crate) mod w0201_section_missing;
pub(crate) mod w0202_object_not_listed;
pub(crate) mod w0203_lists_missing;
pub(crate) mod w0204_supported_objects_count;
pub(crate) mod w0205_list_entry_not_valid;
pub(crate) mod w0206_wrong_list;
pub(crate) mod w0207_listed_twice;
pub(crate) mod w0209_compact_without_key;
pub(crate) mod w0213_section_misspelled;
pub(crate) mod w0214_number_twice;
pub(crate) mod w0215_module_list;
pub(crate) mod w0216_mandatory_key_missing;
pub(crate) mod w0217_dcf_key_in_eds;
pub(crate) mod w0218_list_entry_spelling;
pub(crate) mod w0219_tools_sections;
pub(crate) mod w0241_comment_lines;
pub(crate) mod w0242_list_numbering;
pub(crate) mod w0243_module_section_missing;
pub(crate) mod w0244_list_count;
pub(crate) mod w0245_segment_incomplete;
pub(crate) mod w0246_segment_not_valid;
pub(crate) mod w0247_dynamic_channels_supported;
pub(crate) mod w0248_module_info;
pub(crate) mod w0249_extended_object_missing;
pub(crate) mod w0252_bit_rate_unknown;
pub(crate) mod w0253_dummy_type;
pub(crate) mod w0254_object_links;
