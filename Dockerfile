# syntax=docker/dockerfile:1
FROM python:3.12-slim AS build
ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1
WORKDIR /source
RUN python -m venv /opt/stridewire
# dependencies first, so that they stay cached while the source changes
COPY pyproject.toml README.md LICENSE ./
COPY client/stridewire/_version.py client/stridewire/_version.py
RUN python -c "import tomllib; p = tomllib.load(open('pyproject.toml', 'rb'))['project']; \
print(*p['dependencies'], *p['optional-dependencies']['server'], sep='\n')" > requirements.txt \
    && /opt/stridewire/bin/python -m pip install -r requirements.txt
COPY . .
# the embedded library is built now and passes are compiled, so that the first start needs no time
RUN /opt/stridewire/bin/python -m pip install --no-deps . \
    && XDG_CACHE_HOME=/opt/stridewire/cache /opt/stridewire/bin/python -m stridewire_server.warming

FROM python:3.12-slim
LABEL org.opencontainers.image.title="stridewire" \
      org.opencontainers.image.description="Real-time animation runtime over gRPC" \
      org.opencontainers.image.licenses="Apache-2.0"
COPY --from=build /opt/stridewire /opt/stridewire
# machine code is looked for where it could be written, too; another processor writes its own
COPY --from=build --chown=10001:10001 /opt/stridewire/cache /opt/stridewire/cache
ENV PATH=/opt/stridewire/bin:$PATH \
    XDG_CACHE_HOME=/opt/stridewire/cache \
    MPLCONFIGDIR=/tmp \
    PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1
USER 10001:10001
EXPOSE 50051
HEALTHCHECK --interval=10s --timeout=3s --start-period=60s CMD ["stridewire", "health"]
# there is no access control yet: whoever reaches the port can use it. Publish it to this machine
# alone (docker run -p 127.0.0.1:50051:50051) or put a network of your own around it.
ENTRYPOINT ["stridewire", "serve"]
CMD ["--address", "0.0.0.0:50051", "--insecure"]
