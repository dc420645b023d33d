"""Reading of VXA, VXC and VXD files: the body, its offsets, and the options of ``vox`` for its engine."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from evoframe_simulators.files import naming_source
from evoframe_simulators.vox.vxa.assembling import Document, read_document
from evoframe_simulators.vox.vxa.boxes import read_regions
from evoframe_simulators.vox.vxa.cells import Lattice
from evoframe_simulators.vox.vxa.checking import collect_unsupported
from evoframe_simulators.vox.vxa.compression import COMPRESSIONS
from evoframe_simulators.vox.vxa.dialects import Reading, recognize
from evoframe_simulators.vox.vxa.document import shorten
from evoframe_simulators.vox.vxa.environment import read_surroundings, read_thermal
from evoframe_simulators.vox.vxa.faults import Faults
from evoframe_simulators.vox.vxa.file import VxaFile
from evoframe_simulators.vox.vxa.notes import notes_of, refuse_ambiguity
from evoframe_simulators.vox.vxa.sections import Section
from evoframe_simulators.vox.vxa.simulator import read_collisions, read_integration, read_stop
from evoframe_simulators.vox.vxa.sizes import read_sizes
from evoframe_simulators.vox.vxa.structure import read_canvas, read_material, read_phase

__all__ = ["read_vxa"]

_VERSIONS = ("", "0.93", "0.94")  # of the section VXC; other versions encode the structure differently


def read_vxa(path: Path, dialect: str = "", base: Path | None = None, given: Collection[str] = ()) -> VxaFile:
    """Read a VXA, VXC or VXD file (docs/physics.md, sections 1, 4, 8, 9 and 12).

    Missing tags and sections have the defaults of the engine (see :mod:`.vxa.dialects`). One error reports
    all features that vox does not simulate (see :mod:`.vxa.schema`). These include a search for contacts in
    every step (``ColSystem`` 0 and 1), which finds contacts that the published one misses.

    Args:
        path: The file.
        dialect: Its dialect; empty: told by its tags.
        base: VXA file that completes a VXC or VXD file.
        given: Names of the options that the user sets, which the dialect does not decide.

    Raises:
        InputError: A file cannot be read or is of another kind, uses features that vox does not simulate, or
            means different things in different dialects.
        ConfigurationError: There is no such dialect, or a VXA file has a base.
    """
    document = read_document(path, base)
    with naming_source(path):
        rules = recognize(document.root, dialect)
        return _Reader(document, rules, given, Faults()).file()


@attrs.frozen
class _Reader:
    document: Document
    rules: Reading
    given: Collection[str]
    faults: Faults

    def file(self) -> VxaFile:
        root = self.document.root
        vxc = root.need("VXC")
        structure, palette = vxc.need("Structure"), vxc.need("Palette")
        compression = self._compression(vxc, structure)
        lattice = Lattice(read_canvas(structure), vxc.need("Lattice").number("Lattice_Dim", 0.001, above=0.0))
        count = palette.count("Material")
        material = read_material(structure, lattice.canvas, count, compression)
        used = np.unique(material[material > 0]).tolist()
        collect_unsupported(root, used, self.faults)
        options: dict[str, Any] = {"voxel_size": lattice.edge}
        materials = tuple(
            _properties(found, code) for code, found in enumerate(palette.all("Material"), 1) if code in used
        )
        steps, reach = None, 0.0
        if self.document.complete:
            refuse_ambiguity(root.get("Environment"), self.rules, self.given)
            simulation, steps = self._simulation(lattice)
            options.update(simulation)
            swing = options["temperature_amplitude"] - options["temperature_base"]
            strains = [each["expansion_coefficient"] * swing for each in materials]
            reach = max(map(abs, strains))
            options.update(
                read_sizes(
                    root.get("Simulator"), root.get("Environment"), strains, self.rules.engine, self.faults
                )
            )
        contents = VxaFile(
            options,
            materials,
            material,
            read_phase(structure, lattice.canvas),
            steps,
            self.document.complete,
            self.rules,
            tuple(notes_of(self.document, self.rules, options, reach)),
        )
        if self.faults:  # the user should see all of them at once
            contents.collect_faults(self.given, self.faults)
            self.faults.check()
        return contents

    def _compression(self, vxc: Section, structure: Section) -> str:
        """Return the encoding of the layers; reject unknown ones before anything is decoded."""
        compression = str(structure.element.get("Compression", ""))
        if compression not in COMPRESSIONS:
            expected = ", ".join(filter(None, COMPRESSIONS))
            self.faults.unsupported(
                f"{structure.place} Compression", shorten(compression), f"expected {expected}"
            )
        version = str(vxc.element.get("Version", ""))
        if version not in _VERSIONS:
            self.faults.unsupported(f"{vxc.place} Version", shorten(version), "expected 0.93 or 0.94")
        self.faults.check()
        return compression

    def _simulation(self, lattice: Lattice) -> tuple[dict[str, Any], int | None]:
        """Return the options of the simulation, and the number of steps if the file sets it."""
        simulator, environment = self.document.root.get("Simulator"), self.document.root.get("Environment")
        engine = self.rules.engine
        stop, steps = read_stop(simulator, environment, engine, self.faults, self.given)
        options = {
            "fixed": read_regions(environment, lattice, self.faults),
            **read_integration(simulator),
            **read_collisions(simulator, engine, self.faults),
            **stop,
            **read_surroundings(environment, engine),
            **read_thermal(environment, engine),
        }
        return options, steps


def _properties(found: Section, code: int) -> dict[str, Any]:
    """Return a material of the palette as arguments of ``PaletteMaterial``, with its position as code."""
    mechanical = found.need("Mechanical")
    name = " ".join((found.text("Name") or "").split())
    return {
        "code": code,
        "youngs_modulus": mechanical.number("Elastic_Mod", 0.0),
        "poisson_ratio": mechanical.number("Poissons_Ratio", 0.0),
        "density": mechanical.number("Density", 0.0),
        "expansion_coefficient": mechanical.number("CTE", 0.0),
        "static_friction": mechanical.number("uStatic", 0.0),
        "dynamic_friction": mechanical.number("uDynamic", 0.0),
        "name": name if name.isprintable() else "",
    }
