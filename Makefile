# What a person types. `make help` lists it. Needs GNU make; every target installs or names what it lacks first.

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.NOTPARALLEL:
.DEFAULT_GOAL := help

PREFIX  ?= /usr/local
DESTDIR ?=
# release, or dev for a quick build that the tests use.
PROFILE ?= release
# Of packaging/c. The tests' make the library share their compilation.
FEATURES ?= $(if $(filter dev,$(PROFILE)),shared-build)

TARGET_DIR := $(or $(CARGO_TARGET_DIR),target)
OUT_DIR    := $(TARGET_DIR)/$(if $(filter dev,$(PROFILE)),debug,$(PROFILE))
# The library as `make install` lays it out, for the C hosts that are built here.
STAGE      := $(abspath $(TARGET_DIR))/stage/$(PROFILE)

VERSION   := $(shell sed -n '/^\[workspace\.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
# Grows when a program linked against an older library would no longer run.
ABI_MAJOR := 1

ifeq ($(shell uname -s),Darwin)
  SHARED      := libwelkin.dylib
  SHARED_ABI  := libwelkin.$(ABI_MAJOR).dylib
  SHARED_FULL := libwelkin.$(VERSION).dylib
  LINK_NAME   := -C link-arg=-Wl,-install_name,@rpath/$(SHARED_ABI)
else
  SHARED      := libwelkin.so
  SHARED_ABI  := libwelkin.so.$(ABI_MAJOR)
  SHARED_FULL := libwelkin.so.$(VERSION)
  LINK_NAME   := -C link-arg=-Wl,-soname,$(SHARED_ABI)
endif

# cargo-nextest where it is installed; its summary, or cargo test's, is the last thing that `make test` prints.
NEXTEST  := $(shell cargo nextest --version >/dev/null 2>&1 && echo yes)
RUN_TESTS = $(if $(NEXTEST),cargo nextest run --locked --workspace --no-fail-fast,cargo test --locked --workspace --no-fail-fast --tests)

export PATH := $(PATH):$(HOME)/.cargo/bin

.PHONY: ci dist help setup setup-build lib stage install uninstall host osg-host demo fmt lint header docs test accept bench fuzz gallery lab studio cigi-host on-gpu-pack

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 18

setup: ## install what building, testing and the demo need
	@scripts/setup.sh

setup-build:
	@scripts/setup.sh build

# Both libraries come from one compilation. What a static link needs beside libwelkin.a is the compiler's to say.
lib: setup-build ## build the shared and the static library (PROFILE=release)
	cargo rustc --locked --package welkin-c --profile $(PROFILE) --features "$(FEATURES)" -- \
	    $(LINK_NAME) --print native-static-libs=$(abspath $(OUT_DIR))/native-static-libs.txt

install: lib ## install to PREFIX (/usr/local), below DESTDIR if set
	scripts/install.sh "$(OUT_DIR)" "$(DESTDIR)" "$(PREFIX)" "$(VERSION)" "$(ABI_MAJOR)"

dist: lib ## archives of a release in target/dist: a tar, a Debian package, what `make windows` packed, their sums
	scripts/dist.sh "$(OUT_DIR)" "$(abspath $(TARGET_DIR))/dist" "$(VERSION)" "$(ABI_MAJOR)"

uninstall: ## remove what `make install` put there
	rm -rf "$(DESTDIR)$(PREFIX)/lib/cmake/welkin"
	rm -f "$(DESTDIR)$(PREFIX)/lib/"{$(SHARED),$(SHARED_ABI),$(SHARED_FULL),libwelkin.a} \
	    "$(DESTDIR)$(PREFIX)/lib/pkgconfig/welkin.pc" "$(DESTDIR)$(PREFIX)/include/"{welkin.h,welkin.hpp}

stage: lib
	@scripts/install.sh "$(OUT_DIR)" "" "$(STAGE)" "$(VERSION)" "$(ABI_MAJOR)" >/dev/null

# Built as its users would: by CMake against an installed tree.
host: setup stage
	cmake -S examples/glfw_host -B "$(STAGE)/glfw_host" -DCMAKE_PREFIX_PATH="$(STAGE)" >/dev/null
	cmake --build "$(STAGE)/glfw_host"

osg-host: setup stage ## the OpenSceneGraph host, in a window where there is a display (ARGS="--help")
	cmake -S examples/osg_host -B "$(STAGE)/osg_host" -DCMAKE_PREFIX_PATH="$(STAGE)" >/dev/null
	cmake --build "$(STAGE)/osg_host"
	@[ ! -x "$(STAGE)/osg_host/osg_host" ] || "$(STAGE)/osg_host/osg_host" --data examples/data $(ARGS)

demo: host ## a C simulator with weather in it: a window, or pictures in out/ where there is no display
	@mkdir -p out
	"$(STAGE)/glfw_host/glfw_host" --data examples/data --out out $(DEMO_ARGS)

fmt: ## format the sources
	cargo fmt --all

lint: ## formatting and clippy, warnings are errors
	@cargo fmt --version >/dev/null 2>&1 || { $(call no_tool,rustfmt); exit 0; }; cargo fmt --all --check
	@cargo clippy --version >/dev/null 2>&1 || { $(call no_tool,clippy); exit 0; }; \
	    cargo clippy --locked --workspace --all-targets -- -D warnings

# A check that cannot be made is said, and fails where nobody reads along.
no_tool = echo "lint: $(1) is not installed (rustup component add $(1))" >&2; [ -z "$${CI:-}" ]

header: setup-build ## write include/welkin.h, the ABI lists and the list of the Rust API anew from the sources
	WELKIN_BLESS=1 cargo test --locked --quiet --test abi_header
	WELKIN_BLESS=1 cargo test --locked --quiet --test rooms the_rust_api

.PHONY: windows windows-accept
windows: setup-build ## welkin.dll by MinGW, packed for Windows projects and checked, at most 12 minutes on two cores
	@PROFILE=$(PROFILE) scripts/windows/run.sh

windows-accept: setup-build ## the library's Rust tests for Windows, under Wine
	@scripts/windows/accept.sh

docs: setup-build ## the Rust documentation, warnings are errors
	RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps

# The examples of the documentation, then the tests; the header's drift and the C examples are among them. The profile
# `ci` of .config/nextest.toml (NEXTEST_PROFILE=ci) adds those that take longer than six seconds.
test: setup ## the tests, at most 25 minutes on two cores from a clean clone
	$(MAKE) --no-print-directory lib PROFILE=dev
	cargo test --locked --workspace --doc
	WELKIN_LIB="$(abspath $(TARGET_DIR)/debug/$(SHARED))" $(RUN_TESTS)

ci: export NEXTEST_PROFILE = ci
ci: lint docs test windows drivers ## every check: lint, documentation, all tests, Windows under Wine, other drivers

# Lint and documentation have targets of their own. Benchmarks assert nothing and need an idle machine for longer than
# this takes: `make bench` runs those that a change is about.
accept: export FEATURES = shared-build
accept: setup ## the long sweeps in release, under Wine too, at most 90 minutes on two cores
	$(MAKE) --no-print-directory lib PROFILE=release
	WELKIN_LIB="$(abspath $(TARGET_DIR)/release/$(SHARED))" WELKIN_ACCEPT=1 $(RUN_TESTS) $(if $(NEXTEST),--cargo-profile release --profile accept,--release)
	$(MAKE) --no-print-directory windows-accept

# Other drivers are fetched into target/drivers and stay there; pictures and logs too. Uses the tests' quick build.
.PHONY: drivers drivers-all
drivers: setup ## twelve scenes on other drivers beside this system's, with validation, at most 10 minutes
	$(MAKE) --no-print-directory stage PROFILE=dev
	scripts/drivers.sh "$(abspath $(TARGET_DIR))/stage/dev" "$(abspath $(TARGET_DIR))/drivers"

drivers-all: setup ## every scene, gallery and lab picture on every driver: a good hour, outside `make accept`
	$(MAKE) --no-print-directory host PROFILE=release
	cargo build --locked --release --package welkin-lab
	scripts/drivers-all.sh "$(abspath $(TARGET_DIR))/stage/release" "$(abspath $(TARGET_DIR))/drivers"

gallery: host ## draw the pictures of docs/gallery.md anew, by the demo's host (GALLERY="noon fog": these alone)
	"$(STAGE)/glfw_host/glfw_host" --data examples/data --out docs/gallery --gallery $(GALLERY)

fuzz: setup-build ## fuzz all that Welkin reads, 15 minutes a target (ARGS="--seconds 60 metar")
	scripts/fuzz $(ARGS)

lab: setup-build ## chart speed against accuracy, map where methods fail (ARGS="chart sky"; without: what it can do)
	cargo run --locked --release --package welkin-lab -- $(ARGS)

studio: setup-build ## a window to set, see and write out the weather in (ARGS="--headless --script FILE": without one)
	cargo run --locked --release --package welkin-studio -- $(ARGS)

cigi-host: setup-build ## answer a CIGI host at port 8000 without drawing, or print a capture (ARGS="--decode FILE.bin")
	cargo run --locked --release --package welkin-cigi-host -- $(or $(ARGS),--listen 0.0.0.0:8000)

# Built programs for a machine with a GPU that has no compiler, no network and no display; `scripts/on-gpu` runs them.
ON_GPU := $(TARGET_DIR)/on-gpu
ON_GPU_TESTS := gl_host vulkan_host sky_gpu
executable = sed -n 's/^ *Executable .*(\(.*\))$$/\1/p'

on-gpu-pack: setup-build ## pack what `scripts/on-gpu` needs on a machine with a GPU into target/on-gpu, at most 60 MiB
	cargo build --locked --release --package welkin-on-gpu
	rm -rf "$(ON_GPU)" && mkdir -p "$(ON_GPU)/bin"
	strip -o "$(ON_GPU)/bin/on_gpu" "$(TARGET_DIR)/release/on_gpu"
	for test in $(ON_GPU_TESTS); do \
	    strip -o "$(ON_GPU)/bin/$$test" "$$(cargo test --locked --release --no-run --test $$test 2>&1 | $(executable))"; \
	done
	strip -o "$(ON_GPU)/bin/speed" "$$(cargo bench --locked --no-run --bench speed 2>&1 | $(executable))"
	mkdir "$(ON_GPU)/scripts" && cp scripts/on-gpu scripts/command_line.sh "$(ON_GPU)/scripts" && cp Cargo.toml "$(ON_GPU)"
	@size=$$(du -sm "$(ON_GPU)" | cut -f1); echo "$(ON_GPU): $$size MiB"; [ "$$size" -le 60 ]

bench: setup-build ## speed, as ratios measured within one run
	$(if $(wildcard benches/*.rs benches/*/main.rs),cargo bench --locked --bench '*',@echo "bench: none yet")
