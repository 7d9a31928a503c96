"""`odkit.to_canopen` against python-canopen's own reader."""

import logging
import pathlib
import sys
import warnings

import pytest

import odkit

canopen = pytest.importorskip("canopen")
from canopen.objectdictionary import ODArray, ODRecord, ODVariable  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/interop"))
import differences  # noqa: E402


def files(folder):
    found = sorted(path for path in folder.rglob("*") if path.suffix.lower() in (".eds", ".dcf"))
    assert found
    return found


def reading(od):
    """The parts of an ObjectDictionary that `differences` compares."""
    codes = {ODVariable: 7, ODArray: 8, ODRecord: 9}
    objects = {}
    for index, entry in od.indices.items():
        members = differences.members(entry)
        assert entry.parent is od and all(one.index == index for one in members.values())
        objects[index] = (codes[type(entry)], entry.name, {})
        for sub, one in members.items():
            assert one.subindex == sub and (one.parent is entry or one is entry)
            objects[index][2][sub] = {
                "name": one.name, "type": one.data_type, "access": one.access_type,
                "mapping": one.pdo_mappable, "default": one.default, "low": one.min,
                "high": one.max, "value": one.value,
            }
    return objects


def compare(path):
    """Differences of no kind, and whether python-canopen reads the file."""
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    try:
        own = odkit.to_canopen(path, differences.NODE_ID)
        found = list(differences.compare(path, reading(own)))
        unknown = [one for one in found if one[0] not in differences.KINDS]
        if any(place == "" for _, place, _, _ in found):
            return unknown, False
        theirs = canopen.import_od(str(path), differences.NODE_ID)
        pairs = [(what, getattr(theirs, what), getattr(own, what)) for what in ("node_id", "bitrate", "comments")]
        info = vars(own.device_information)
        pairs += [(what, value, info[what]) for what, value in vars(theirs.device_information).items()]
        # python-canopen knows a key in one spelling, and overlooks it in another.
        unknown += [(None, *one) for one in pairs if one[1] and one[1] != one[2]]
        return unknown + list(kinds(own, theirs)), True
    finally:
        logging.disable(logging.NOTSET)


def kinds(own, theirs):
    """Attributes that no rule is about have to be equal."""
    for index in set(own.indices) & set(theirs.indices):
        one, other = own.indices[index], theirs.indices[index]
        if type(one) is not type(other) and isinstance(other, (ODArray, ODRecord)):
            yield None, f"{index:04X}h", other, one
        mine = differences.members(one)
        for sub, value in differences.members(other).items():
            if sub not in mine or mine[sub].default is None or value.default is None:
                continue
            if value.relative and not mine[sub].relative:
                yield None, f"{index:04X}h:{sub:02X} relative", True, False
            for what in ("default_raw", "factor", "unit", "description", "storage_location"):
                if getattr(mine[sub], what) != getattr(value, what) and mine[sub].name == value.name:
                    yield None, f"{index:04X}h:{sub:02X} {what}", getattr(value, what), getattr(mine[sub], what)


def test_the_projects_own_files_are_equal():
    both = 0
    own = [ROOT / folder for folder in ("devices/eds", "tests/interop", "firmware/eds", "crates/od-cli/tests")]
    for path in sum(map(files, own), []):
        unknown, read = compare(path)
        assert unknown == [], path.name
        both += read
    assert both >= 7


def test_files_that_python_canopen_refuses():
    """Examples of the rules about text and structure: what is wrong there stops python-canopen, and not odkit."""
    refused = 0
    for path in sorted((ROOT / "crates/od-eds/cases").glob("[EW]0[1-3]*/bad.eds")):
        described = odkit.read(path)
        if len(described) > 0:
            assert set(odkit.to_canopen(path)) >= {one.index for one in described}, path
            refused += not is_read(path)
    assert refused >= 10


def is_read(path):
    """Whether python-canopen reads a file; there is no end to what it raises."""
    try:
        return canopen.import_od(str(path), differences.NODE_ID) is not None
    except Exception:
        return False


def test_the_corpus_is_equal():
    for path in files(differences.corpus()):
        unknown, _ = compare(path)
        assert unknown == [], path


def test_the_node_id(tmp_path):
    path = ROOT / "devices/eds/GXMM.eds"
    for node_id in (None, 5):
        own, theirs = odkit.to_canopen(path, node_id), canopen.import_od(str(path), node_id)
        assert own[0x1800][1].default == theirs[0x1800][1].default == (node_id and 0x185)
        assert own[0x1800][1].relative and own.node_id == theirs.node_id
    dcf = tmp_path / "five.dcf"
    odkit.convert(path, output=dcf, node_id=5, bit_rate=250, values={0x1017: 7})
    own, theirs = odkit.to_canopen(dcf), canopen.import_od(str(dcf))
    assert (own.node_id, own.bitrate) == (theirs.node_id, theirs.bitrate) == (5, 250_000)
    assert own[0x1017].value == theirs[0x1017].value == 7
    assert own[0x1800][1].default == 0x185


def test_a_node_of_python_canopen_works_with_it():
    with odkit.Bench("gxmm@5") as bench:
        network = canopen.Network()
        network.connect(interface="odkit", channel=bench.name)
        node = network.add_node(5, odkit.to_canopen("gxmm", 5))
        assert node.sdo["Manufacturer device name"].raw == "GXMM"
        assert node.sdo[0x1018][1].raw == 0xEC
        node.tpdo.read()
        assert node.tpdo[1].cob_id == 0x185
        network.disconnect()


def test_what_cannot_be_read():
    with pytest.raises(FileNotFoundError, match="`none.eds`"):
        odkit.to_canopen("none.eds")
    with pytest.raises(ValueError, match="text does not define any object"):
        odkit.to_canopen("no\nEDS\n")
    with pytest.raises(ValueError, match="1 to 127"):
        odkit.to_canopen("gxmm", 200)
