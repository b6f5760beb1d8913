"""Welkin for Conan 2: `conan create packaging/conan`, in a clone. Builds the library with Cargo by `make lib`; with
`-c user.welkin:tree=DIR` it packs an installed tree or an unpacked archive as it is."""

import os
import re

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.files import copy, load


class Welkin(ConanFile):
    name = "welkin"
    description = "Weather for simulators behind one C header"
    license = "MIT OR Apache-2.0"
    topics = ("weather", "simulation", "rendering")
    package_type = "library"
    settings = "os", "arch"
    options = {"shared": [True, False]}
    default_options = {"shared": True}

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        cargo = load(self, os.path.join(self._root, "Cargo.toml"))
        self.version = re.search(r'^version = "(.*)"', cargo, re.MULTILINE).group(1)

    def export_sources(self):
        for part in ("src/*", "shaders/*", "build/*", "include/*", "packaging/*", "scripts/*", "benches/*", "examples/*", "tests/support/*"):
            copy(self, part, self._root, self.export_sources_folder)
        for part in ("Cargo.*", "build.rs", "cbindgen.toml", "Makefile", "LICENSE-*", "README.md"):
            copy(self, part, self._root, self.export_sources_folder)

    def validate(self):
        if self.settings.os != "Linux":
            raise ConanInvalidConfiguration("this recipe builds on Linux")

    def _tree(self):
        return self.conf.get("user.welkin:tree", check_type=str)

    def build(self):
        if not self._tree():
            self.run(f"make install PREFIX={self.build_folder}/tree", cwd=self.source_folder)

    def package(self):
        tree = self._tree() or os.path.join(self.build_folder, "tree")
        for part in ("lib/*", "include/*", "LICENSE-*"):
            copy(self, part, tree, self.package_folder)

    def package_info(self):
        # Welkin's own CMake package, as every installed tree has it.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "welkin")]
        self.cpp_info.libs = ["welkin"]
        if not self.options.shared:
            self.cpp_info.system_libs = ["dl", "pthread", "m"]
