# Everything for a user and for a developer, from a fresh Debian machine on: `make help` lists it.
# Built under $(BUILD) and target/.

# rustup puts cargo here, and on PATH only from the next login.
export PATH := $(PATH):$(HOME)/.cargo/bin

BUILD ?= build
JOBS ?= $(shell nproc)

# Of Debian's assimp-testmodels, which every machine can have.
engine = /usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb

# Those that README.md shows, as far as the machine has them; the engine is one of those in ../shared/scenes.
scenes = $(or $(wildcard ../shared/scenes/*.glb),$(engine)) \
         gen:terrain gen:interior gen:hair

# Debian's own, for which its packages are.
python = $(or $(wildcard /usr/bin/python3),python3)

ctest = ctest --output-on-failure --no-tests=error --parallel $(JOBS)

.DEFAULT_GOAL := help
.PHONY: help build compare bench structures report render test test-slow hard check test-rust test-c test-sanitized format clean packages packages-report packages-test cargo

help: ## List the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-16s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

build: packages cargo ## Build the library, gnomon-compare and gnomon-bench
	cmake -S . -B $(BUILD)
	cmake --build $(BUILD) --parallel $(JOBS) --target gnomon-compare gnomon-bench

compare: OUT ?= $(BUILD)/compare
compare: SCENE ?= $(scenes)
compare: build ## Compare with Embree; SCENE="file.glb gen:NAME ..." OUT=dir ARGS="options of gnomon-compare"
	@mkdir -p $(OUT)
	@status=0; \
	$(BUILD)/bin/gnomon-compare --json $(OUT)/compare.json --html $(OUT)/report.html $(ARGS) $(SCENE) || status=$$?; \
	[ $$status -gt 1 ] || echo "results: $(OUT)/compare.json and $(OUT)/report.html"; \
	exit $$status

bench: OUT ?= $(BUILD)/bench
bench: build ## Measure against Embree and the project's bars, about 20 minutes; ARGS=--quick, SCENE= and OUT= as above
	@mkdir -p $(OUT)
	@$(BUILD)/bin/gnomon-bench --json $(OUT)/bench.json --html $(OUT)/report.html $(ARGS) $(SCENE)
	@echo "results: $(OUT)/bench.json and $(OUT)/report.html"

structures: OUT ?= $(BUILD)/structures
structures: build ## Which structure when: each beside the scalar BVH, about 7 minutes; ARGS=--quick, SCENE= and OUT= as above
	@mkdir -p $(OUT)
	@$(BUILD)/bin/gnomon-bench --structures --json $(OUT)/bench.json --html $(OUT)/report.html $(ARGS) $(SCENE)
	@echo "results: $(OUT)/bench.json and $(OUT)/report.html"

report: OUT ?= $(BUILD)/report
report: SCENE ?= $(scenes)
report: ARGS ?= --structures brute_force,grid,octree,kd_tree,bsp_tree,bvh,wide_bvh --most-triangles brute_force:2500,bsp_tree:150000 \
                --ray-count 20000 --oracle-rays 4000 --repeats 3 --build-repeats 1 --threads $(JOBS)
report: HARD_ARGS ?= --rays 5000
report: CORNELL_ARGS ?= --width 400 --height 400 --samples 64 --exposure 7.7
report: packages-report build ## Speed against error of every structure and precision, the hard cases, and light, about 16 minutes, or with HARD_ARGS= an hour; SCENE= and OUT= as above
	cmake --build $(BUILD) --parallel $(JOBS) --target gnomon-hard gnomon-light gnomon-render
	@mkdir -p $(OUT)
	@status=0; \
	$(BUILD)/bin/gnomon-compare --json $(OUT)/compare.json --precisions all $(ARGS) $(SCENE) || status=$$?; \
	[ $$status -gt 1 ] || $(BUILD)/bin/gnomon-hard --json $(OUT)/hard.json $(HARD_ARGS) || status=$$?; \
	[ $$status -gt 1 ] || $(BUILD)/bin/gnomon-light --json $(OUT)/light.json $(LIGHT_ARGS) || status=$$?; \
	[ $$status -gt 1 ] || $(BUILD)/bin/gnomon-render gen:furnace --furnace $(OUT)/furnace.json || status=$$?; \
	for method in path whitted; do \
	    [ $$status -gt 1 ] || $(BUILD)/bin/gnomon-render gen:cornell --method $$method --out $(OUT)/cornell-$$method $(CORNELL_ARGS) || status=$$?; \
	done; \
	[ $$status -gt 1 ] || $(python) c_tests/report/report.py --compare $(OUT)/compare.json --hard $(OUT)/hard.json \
	    --light $(OUT)/light.json --furnace $(OUT)/furnace.json --path-png $(OUT)/cornell-path.png --whitted-png $(OUT)/cornell-whitted.png \
	    --html $(OUT)/index.html --svg $(OUT)/speed-against-error.svg || status=$$?; \
	[ $$status -gt 1 ] || echo "results: $(OUT)/index.html and $(OUT)/speed-against-error.svg"; \
	exit $$status

render: OUT ?= $(BUILD)/render
render: SCENE ?= $(engine)
render: packages cargo ## Render pictures in nits; SCENE="file.glb gen:cornell ..." OUT=dir ARGS="options of gnomon-render"
	cmake -S . -B $(BUILD)
	cmake --build $(BUILD) --parallel $(JOBS) --target gnomon-render
	@for scene in $(SCENE); do $(BUILD)/bin/gnomon-render --out $(OUT)/ $(ARGS) "$$scene" || exit; done

test: packages-test cargo check test-rust test-sanitized test-c ## Check the style and run all but the slow tests

check: cargo
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- --deny warnings
	find c_tests -name '*.[ch]' -o -name '*.[ch]pp' | xargs clang-format --dry-run --Werror

test-rust: cargo
	if cargo nextest --version >/dev/null 2>&1; \
	then cargo nextest run --locked --cargo-quiet && cargo test --locked --doc --quiet; \
	else cargo test --locked --quiet; fi

test-c: cargo
	cmake -S . -B $(BUILD)
	cmake --build $(BUILD) --parallel $(JOBS)
	$(ctest) --test-dir $(BUILD) --label-exclude slow

test-sanitized: cargo ## The C interface's suites under AddressSanitizer and UndefinedBehaviorSanitizer
	cmake -S . -B $(BUILD)/sanitized -DGNOMON_SANITIZE=ON
	cmake --build $(BUILD)/sanitized --parallel $(JOBS) --target api_suites
	$(ctest) --test-dir $(BUILD)/sanitized --label-regex api --tests-regex '_suite$$'

test-slow: packages-test cargo ## Run the slow tests
	cmake -S . -B $(BUILD)
	cmake --build $(BUILD) --parallel $(JOBS)
	$(ctest) --test-dir $(BUILD) --label-regex slow

hard: OUT ?= $(BUILD)/hard
hard: packages-test cargo ## The hard cases and populations in full, the bars, then 10^8 rays of each class at seams: hours; ARGS=, OUT=dir
	cmake -S . -B $(BUILD)
	cmake --build $(BUILD) --parallel $(JOBS) --target gnomon-hard leak_suite
	@mkdir -p $(OUT)
	$(BUILD)/bin/gnomon-hard --json $(OUT)/hard.json --dump-failures $(OUT)/failures.txt $(ARGS)
	GNOMON_RAYS=100000000 $(BUILD)/c_tests/suites/leak_suite

format: cargo ## Format the Rust, C and C++ sources
	cargo fmt --all
	find c_tests -name '*.[ch]' -o -name '*.[ch]pp' | xargs clang-format -i

clean: ## Remove what was built
	rm -rf $(BUILD) target

packages:
	@sh cmake/debian-packages.sh compare

packages-report:
	@sh cmake/debian-packages.sh report

packages-test:
	@sh cmake/debian-packages.sh test

cargo:
	@command -v cargo >/dev/null || { echo "cargo is missing: install Rust from https://rustup.rs, then run make again"; exit 1; }
