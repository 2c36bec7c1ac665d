# What people type. Each recipe is a script under packaging/ or a cargo command; none is hidden here.
.DEFAULT_GOAL := help
.PHONY: help setup fmu demo test bench convergence release gap-check paper win64 docs pictures clean chain leak-check fuzz sanitize coverage

PYTHON := .venv/bin/python
CAMPAIGNS ?= ../shared/measurements/open
# The tests that take minutes, not more, when every line is counted.
TESTS ?= --lib --test effects --test contact_effects --test energy --test ringdown --test reduction --test gap --test cli

help: ## This list
	@grep -hE '^[a-z0-9-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | sort | expand -t 14

setup: ## Install everything: compiler, libclang, Python packages (quick if nothing is missing)
	@packaging/setup.sh build run test

fmu: ## Build out/TreadBlock.fmu (linux64, any distribution since 2012)
	@packaging/setup.sh build
	@packaging/linux64.sh

demo: ## Build the FMU, run it in fmpy, draw plots to out/demo/
	@packaging/setup.sh build run
	@packaging/linux64.sh
	@$(PYTHON) demo/demo.py

chain: ## Belt source, block and acoustic stage in three masters: pictures and sound in out/chain/
	@packaging/setup.sh build run test
	@packaging/linux64.sh
	@packaging/chain.sh
	@$(PYTHON) examples/chain/chain.py

test: ## Set up and run every test
	@packaging/setup.sh build run test
	@packaging/test.sh

bench: ## Every speed goal as a ratio measured side by side: out/bench/summary.csv (needs the FMU)
	@packaging/setup.sh build run test bench
	@packaging/linux64.sh
	@$(PYTHON) benches/bench.py

fuzz: ## Hostile inputs of each kind, N of them (default 20000); failures are kept in tests/hostile/corpus
	@packaging/setup.sh build
	@TREAD_FUZZ=$(or $(N),20000) cargo test --test hostile

sanitize: ## The C hosts under AddressSanitizer, UndefinedBehaviorSanitizer and LeakSanitizer
	@packaging/setup.sh build
	@packaging/sanitize.sh

leak-check: ## 1000 times instantiate, run, free under valgrind (some minutes)
	@packaging/setup.sh build run test
	@packaging/linux64.sh
	@TREAD_LEAK_CYCLES=1000 $(PYTHON) -m pytest -q tests/python/test_c_host.py -k valgrind

convergence: ## Error over internal step and mesh: out/convergence/
	@packaging/setup.sh build
	@cargo run --quiet --release --example convergence

win64: ## Build the win64 library and run it under wine
	@packaging/setup.sh build
	@packaging/win64.sh

release: ## The FMU for linux64 and win64, checked, with its checksums, in out/release/
	@packaging/setup.sh build run test
	@packaging/release.sh

gap-check: ## Diagnose the labelled campaigns (CAMPAIGNS=folder) and score the answers
	@packaging/setup.sh build
	@cargo run --quiet --release --bin tread -- gap check $(CAMPAIGNS)

paper: ## The paper's studies on this model: out/paper/index.html
	@packaging/setup.sh build
	@cargo run --quiet --release --bin tread -- study all --out out/paper

coverage: ## Lines that the Rust tests reach, by module, in out/coverage (TESTS="--lib --test gap": others)
	@packaging/setup.sh build run test
	@packaging/coverage.sh $(TESTS)

docs: ## The book in docs/book (mdbook, warnings are errors) and the Rust documentation
	@packaging/setup.sh build docs
	@docs/build.sh
	@RUSTDOCFLAGS="-D warnings" cargo doc --no-deps

pictures: ## Pictures of README and book, in docs/src/images (PARTS="demo gap"; also convergence chain bench)
	@packaging/setup.sh build run
	@docs/pictures.sh $(PARTS)

clean: ## Remove what was built (keeps .venv)
	@rm -rf target out
