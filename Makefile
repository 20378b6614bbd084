# The documented commands; each sets up what it needs.
PYTHON ?= python3
VENV ?= .venv
PROTO_VENV ?= .proto-venv
BIN := $(VENV)/bin
PAGE := server/stridewire_server/page/source
PIP := $(BIN)/python -m pip --disable-pip-version-check
# where the motion capture lies, for tests and checks that need it; they skip without
STRIDEWIRE_DATA ?= $(abspath ../shared/data)
export STRIDEWIRE_DATA PROTO_VENV

.PHONY: demo test lint proto show-blend show-spine show-search show-import show-gait show-surface show-judge show-page show-refiner show-capacity show-soak page page-pictures site pictures reference image clean help
.DEFAULT_GOAL := help

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 14

demo: $(VENV)/.server ## drive characters over gRPC for 10 s; LIBRARY=FOLDER drives a library of yours
	$(BIN)/stridewire demo $(if $(LIBRARY),--library "$(LIBRARY)")

test: $(VENV)/.dev ## run all tests
	$(BIN)/python -m stridewire_server.warming
	$(BIN)/pytest -n 2 --dist worksteal

lint: $(VENV)/.dev ## check style, types, contract and Dockerfile
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/buf lint
	$(BIN)/hadolint Dockerfile

proto: $(PROTO_VENV)/.ready ## make the stubs anew after a change in proto/
	$(PROTO_VENV)/bin/python -m grpc_tools.protoc -Iproto --python_out=client --pyi_out=client \
		--grpc_python_out=client $$(find proto -name '*.proto')

show-spine: $(VENV)/.dev ## check what the service claims, point by point
	$(BIN)/python tests/show/spine.py $(SHOW)

show-search: $(VENV)/.dev ## check what the search claims, up to a million frames
	$(BIN)/python tests/show/search.py $(SHOW)

show-import: $(VENV)/.dev ## check what import and the synthetic library claim, over the whole capture
	$(BIN)/python tests/show/importing.py $(SHOW)

show-gait: $(VENV)/.dev ## check what the synthetic library claims alone
	$(BIN)/python tests/show/gait.py $(SHOW)

show-blend: $(VENV)/.dev ## check what posture blending claims, on people that its network never saw
	$(BIN)/python tests/show/blend.py $(SHOW)

show-surface: $(VENV)/.dev ## check what the interface claims, over the wire and in process
	PYTHONPATH=tests $(BIN)/python tests/show/surface.py $(SHOW)

show-judge: $(VENV)/.dev ## check how good streamed motion is, beside the captured and a naive baseline
	$(BIN)/python tests/show/judge.py $(SHOW)

show-page: $(VENV)/.dev ## check the page, files, engines, documents; BLENDER_PYTHON=PYTHON asks Blender, too
	PYTHONPATH=tests $(BIN)/python tests/show/page.py $(SHOW)

site: $(VENV)/.dev ## build the documents as web pages, build/site/index.html, all links checked
	$(BIN)/python docs/site/build.py

pictures: $(VENV)/.server ## draw the animation of the README anew
	$(BIN)/python tests/docs/pictures.py

page-pictures: $(VENV)/.dev ## take the pictures of the page anew; needs Chromium
	$(BIN)/python tests/docs/page_pictures.py

page: ## bundle the page of `stridewire play` anew after a change in its sources
	npm ci --silent --ignore-scripts --prefix $(PAGE)
	npm run --silent build --prefix $(PAGE)

show-refiner: $(VENV)/.dev ## check what stitching claims, as a service and by its network
	$(BIN)/python tests/show/refiner.py $(SHOW)

show-capacity: $(VENV)/.dev ## check how much two cores hold; wants a machine that does nothing else
	PYTHONPATH=tests $(BIN)/python tests/show/capacity.py $(SHOW)

show-soak: $(VENV)/.dev ## check twenty minutes near capacity; wants a machine that does nothing else
	$(BIN)/python tests/show/soak.py $(SHOW)

reference: $(VENV)/.dev ## write docs/reference.md anew after a change in proto/ or a command
	$(BIN)/python tests/docs/reference.py > docs/reference.md

image: ## build the container image
	docker build -t stridewire .

clean: ## remove what the other targets made
	rm -rf $(VENV) $(PROTO_VENV) build dist demo.bvh demo.png
	rm -rf .mypy_cache .pytest_cache .ruff_cache

$(VENV)/.server: pyproject.toml | $(BIN)/python
	@echo "installing stridewire and what the server needs into $(VENV) …"
	$(PIP) install -q -e '.[server]'
	@touch $@

$(VENV)/.dev: pyproject.toml | $(BIN)/python
	@echo "installing stridewire and the development tools into $(VENV) …"
	$(PIP) install -q -e '.[dev]'
	@touch $@ $(VENV)/.server

# the oldest supported generator; its pkg_resources went away with setuptools 80
$(PROTO_VENV)/.ready:
	$(PYTHON) -m venv $(PROTO_VENV)
	$(PROTO_VENV)/bin/python -m pip install -q --disable-pip-version-check 'grpcio-tools==1.62.3' 'setuptools<80'
	@touch $@

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "$(PYTHON) is older than 3.11: make PYTHON=python3.11 …"; exit 1; }
	$(PYTHON) -m venv $(VENV)
