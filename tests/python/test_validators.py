"""Validators that we did not write find nothing to complain about."""

import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import lxml.etree as etree
import pytest
from fmpy.validation import validate_fmu


def test_fmpy_finds_no_problem(fmu):
    assert validate_fmu(str(fmu)) == []


def test_the_description_obeys_the_schema(fmu):
    schema = Path(fmpy.__file__).parent / "schema" / "fmi2" / "fmi2ModelDescription.xsd"
    description = etree.fromstring(zipfile.ZipFile(fmu).read("modelDescription.xml"))
    etree.XMLSchema(etree.parse(str(schema))).assertValid(description)


def test_fmureader_understands_every_variable(fmu, description):
    """A reader on pydantic models: strict about kinds and enumerations, shares no code with fmpy."""
    fmi2 = pytest.importorskip("fmureader.fmi2")
    read = fmi2.read_model_description(str(fmu))
    assert read.guid == description.guid
    names = [variable.name for variable in read.model_variables]
    assert names == [variable.name for variable in description.modelVariables]


def test_fmutool_finds_no_problem(fmu):
    tool = Path(sys.executable).parent / "fmutool"
    done = subprocess.run([tool, "-input", fmu, "-check"], capture_output=True, text=True, timeout=120)
    told = done.stdout + done.stderr
    assert done.returncode == 0, told
    assert not [line for line in told.splitlines() if line.startswith(("ERROR", "WARNING"))], told
    assert "compliant with FMI-2.0" in told and "No semantic error" in told, told


def test_every_real_variable_has_a_unit_and_every_variable_a_description(description):
    for variable in description.modelVariables:
        assert variable.description, variable.name
        if variable.type == "Real":
            assert variable.unit, variable.name


def test_the_archive_holds_what_the_standard_asks_for(fmu):
    archive = zipfile.ZipFile(fmu)
    names = archive.namelist()
    for name in ["modelDescription.xml", "model.png", "binaries/linux64/TreadBlock.so",
                 "documentation/index.html", "documentation/licenses/license.txt",
                 "documentation/externalDependencies.txt", "resources/parameters.toml"]:
        assert name in names
    assert not any("\\" in name for name in names)
    assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
