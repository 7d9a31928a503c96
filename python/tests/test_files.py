"""Device descriptions: read, check, fix, convert, compare, overlays."""

import errno
import os
import pathlib

import pytest

import odkit

HERE = pathlib.Path(__file__).parent
EDS = HERE.parent.parent / "devices/eds/GXMM.eds"
WRONG = "[2300]\nParameterName=Reset\nDataType=0x0005\nAccessType=rw\nDefaultValue=300\n"


@pytest.fixture(scope="module")
def gxmm():
    return odkit.read(EDS)


def test_objects_are_found_by_address_and_name(gxmm):
    position = gxmm[0x6004]
    assert (position.index, position.name, position.code) == (0x6004, "Position value", "VAR")
    assert (position.data_type, position.access, position.mappable) == ("UNSIGNED32", "ro", True)
    assert position.default == 0 and position.low is None and len(position) == 1
    for key in ("Position value", "position VALUE", "6004h", "0x6004"):
        assert gxmm[key].index == 0x6004
    identity = gxmm[0x1018]
    assert (identity.code, identity.default, len(identity)) == ("RECORD", None, 5)
    assert [entry.sub for entry in identity] == [0, 1, 2, 3, 4]
    for entry in (identity[1], identity["Vendor-ID"], gxmm[0x1018, 1], gxmm["1018h:01"]):
        assert (entry.index, entry.sub) == (0x1018, 1)
        assert (entry.default, entry.bits, entry.type_code) == (0xEC, 32, 7)
    assert gxmm["Identity object.Vendor-ID"].default == 0xEC
    assert 0x6004 in gxmm and (0x1018, 9) not in gxmm and "no such" not in gxmm
    assert [one.index for one in gxmm] == sorted(one.index for one in gxmm.objects)
    assert len(gxmm.entries) == sum(len(one) for one in gxmm)
    assert gxmm.get(0x7777) is None and gxmm.get(0x7777, 5) == 5


def test_what_is_not_there_is_said_in_words(gxmm):
    with pytest.raises(KeyError, match="object 7777h does not exist"):
        gxmm[0x7777]
    with pytest.raises(KeyError, match="the nearest name is `Position value`"):
        gxmm["Positon value"]
    with pytest.raises(KeyError, match="1018h has no value 9; its sub-indices are 0, 1, 2, 3, 4"):
        gxmm[0x1018][9]
    with pytest.raises(FileNotFoundError, match="no built-in device or file is named `none.eds`"):
        odkit.read("none.eds")
    with pytest.raises(OSError):
        odkit.read(HERE)


def test_values_have_their_types(gxmm):
    cob_id = gxmm[0x1800][1]
    assert cob_id.relative and repr(cob_id.default) == "$NODEID+0x180" and cob_id.default.at(5) == 0x185
    assert odkit.read(EDS, 5)[0x1800, 1].default == 0x185
    text = "[2000]\nParameterName=a\nDataType={}\nAccessType=rw\nDefaultValue={}\nLowLimit={}\nUnit=mm\n"
    for data_type, given, value in [
        ("1", "1", True),
        ("2", "0xFF", -1),
        ("7", "0x10", 16),
        ("8", "1.5", 1.5),
        ("9", "a text", "a text"),
        ("0xA", "12AB", b"\x12\xab"),
        ("0xB", "ab", "ab"),
    ]:
        entry = odkit.read(text.format(data_type, given, ""))[0x2000, 0]
        assert entry.default == value and type(entry.default) is type(value), data_type
    limited = odkit.read(text.format("3", "1", "-5"))[0x2000]
    assert (limited.low, limited.high, limited[0].extra) == (-5, None, {"Unit": "mm"})


def test_identity_and_sections(gxmm):
    identity = gxmm.identity
    assert (identity.vendor_id, identity.product_code, identity.profile) == (0xEC, 10, 406)
    assert identity.product_name == "GXMM" and "CiA 406" in repr(identity)
    assert gxmm.sections["DeviceInfo"]["VendorName"] == "odkit virtual devices"
    assert (gxmm.kind, gxmm.node_id, gxmm.encoding) == ("eds", None, "ASCII")
    dcf = odkit.read(odkit.convert(gxmm, "dcf", node_id=5, bit_rate=500))
    assert (dcf.kind, dcf.node_id, dcf.bit_rate, dcf[0x1800, 1].default) == ("dcf", 5, 500, 0x185)


def test_findings_have_lines(tmp_path):
    path = tmp_path / "wrong.eds"
    path.write_bytes(WRONG.replace("Reset", "R\xe9set").encode("latin-1"))
    found = next(one for one in odkit.check(path) if one.code == "E0412")
    assert (found.line, found.column, found.index, found.sub) == (5, 14, 0x2300, 0)
    assert (found.severity, found.path) == ("error", str(path))
    assert str(found).endswith("error[E0412] 2300h: DefaultValue `300` is not a valid UNSIGNED8")
    assert "0 to 255" in found.help and found.why and found.source
    read = odkit.read(path)
    assert read[0x2300].name == "R\xe9set" and read.encoding == "Windows-1252"
    assert [str(one) for one in read.findings] == [str(one) for one in odkit.check(read)]
    with pytest.raises(ValueError, match=r"wrong.eds: line 5: E0412 DefaultValue `300`"):
        odkit.read(path, strict=True)
    assert odkit.check(EDS) == [] and odkit.check(path.read_bytes())[0].path is None


def test_check_for_a_tool():
    text = EDS.read_text().replace("DefaultValue=0x20196", "DefaultValue=010", 1)
    found = [one for one in odkit.check(text, for_="python-canopen") if one.tool]
    assert [(one.code, one.tool, one.index) for one in found] == [("T0112", "python-canopen", 0x1000)]
    assert {one.tool for one in odkit.check(text, for_="all")} > {None, "python-canopen"}
    with pytest.raises(ValueError, match="tool `excel` is not known; the tools are python-canopen"):
        odkit.check(text, for_=["excel"])


def test_fix(tmp_path):
    path = tmp_path / "a.eds"
    path.write_bytes(b"[2000]\r\nParameterName=\xb5\r\nDataType:5\r\nAccessType=rw\r\n")
    fixed = odkit.fix(path)
    assert fixed.edits == 1 and b"DataType=5\r\n" in fixed.data and "DataType:5" in odkit.read(path).text
    fixed.save()
    assert path.read_bytes() == fixed.data and odkit.fix(path).edits == 0
    swapped = WRONG.replace("=300", "=3\nLowLimit=9\nHighLimit=2")
    assert odkit.fix(swapped, unsafe=True).edits > odkit.fix(swapped).edits
    with pytest.raises(ValueError, match="came from no file"):
        odkit.fix("[2000]\nParameterName=a\n").save()


def test_a_file_that_cannot_be_written_or_read_is_named(tmp_path, gxmm):
    path = tmp_path / "missing" / "a.log"
    bench = odkit.Bench("gxmm@1")
    actions = [
        lambda: odkit.fix("gxmm").save(path),
        lambda: gxmm.save(path),
        lambda: odkit.convert(gxmm, "md", path),
        lambda: bench.save_log(path),
        lambda: bench["gxmm"].save_eeprom(path),
        lambda: bench["gxmm"].load_eeprom(path),
    ]
    for action in actions:
        with pytest.raises(FileNotFoundError) as raised:
            action()
        assert raised.value.filename == str(path) and raised.value.errno == errno.ENOENT
        assert "os error" not in str(raised.value)


def test_convert(tmp_path, gxmm):
    again = odkit.read(odkit.convert(gxmm, "xdd"))
    assert again.kind == "xdd" and odkit.diff(gxmm, again) == []
    assert odkit.convert(EDS, output=tmp_path / "gxmm.json") == (tmp_path / "gxmm.json").read_text()
    files = odkit.convert("gxmm", "canopennode", tmp_path / "OD.c")
    assert sorted(files) == ["OD.c", "OD.h"] and (tmp_path / "OD.h").read_text() == files["OD.h"]
    dcf = odkit.read(odkit.convert(gxmm, "dcf", node_id=5, values={0x1017: 100, (0x1800, 2): 1}))
    assert (dcf[0x1017].value, dcf[0x1800, 2].value) == (100, 1)
    for arguments, why in [
        ({"to": "pdf"}, "format `pdf` is not known; write eds, dcf"),
        ({"to": "dcf"}, "a DCF needs a node ID"),
        ({"to": "eds", "bit_rate": 500}, "are for `dcf`"),
        ({"to": "dcf", "node_id": 5, "values": {0x6004: 1}}, "cannot be set"),
    ]:
        with pytest.raises(ValueError, match=why):
            odkit.convert(gxmm, **arguments)
    with pytest.raises(ValueError, match="text does not define any object"):
        odkit.convert("no\nEDS\n", "json")
    untyped = WRONG.replace("DataType=0x0005\n", "")
    with pytest.raises(ValueError, match="line 1: E0401"):
        odkit.convert(untyped, "md")
    assert odkit.convert(untyped, "md", lossy=True)


def test_diff(gxmm):
    other = gxmm.text.replace("DefaultValue=0x20196", "DefaultValue=0x10196", 1)
    (one,) = odkit.diff(gxmm, other)
    assert (one.place, one.field, one.breaking, one.index, one.sub) == ("1000h", "default", True, 0x1000, None)
    assert str(one) == '1000h "Device type": default: 0x00020196 -> 0x00010196 (breaking)'
    assert odkit.diff("gxmm", "gxmm") == []


def test_overlays(tmp_path, gxmm):
    over = "[1017]\nDefaultValue=70000\n"
    path = tmp_path / "fast.overlay"
    path.write_text(over)
    for laid in (odkit.read(f"{EDS}+{path}"), odkit.overlay(EDS, path)):
        (error,) = laid.errors
        assert (error.path, error.line, error.code) == (str(path), 2, "E0412")
        assert laid[0x6004].name == "Position value"
    for base in (gxmm.text, gxmm, odkit.read(gxmm)):
        good = odkit.overlay(base, "[1017]\nDefaultValue=250\n", node_id=5)
        assert (good[0x1017].default, good[0x1800, 1].default) == (250, 0x185)
    with pytest.raises(ValueError, match="`node_id` must be 1 to 127"):
        odkit.overlay(gxmm, "[1017]\nDefaultValue=250\n", node_id=200)
    with pytest.raises(ValueError, match=r"overlay: line 1: section \[7777\] to remove is missing"):
        odkit.overlay(EDS, "[7777]\nRemove=1\n")
    with pytest.raises(ValueError, match="fix base and overlay one by one"):
        odkit.fix(f"{EDS}+{path}")
    with pytest.raises(ValueError, match=r"fast.overlay: line 2: E0412"):
        odkit.Bench(f"{EDS}+{path}@1")


def test_every_built_in_device_is_read():
    for name, _ in odkit.devices():
        assert odkit.read(name).errors == [] and os.path.basename(odkit.read(name).path) == name
