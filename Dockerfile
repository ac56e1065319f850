# hedon as an image for clusters.
#   docker build -t hedon .                                    (or podman, buildah)
#   docker run --rm -v "$PWD/runs:/data/runs" hedon run baseline
#   apptainer build hedon.sif docker-daemon://hedon:latest     (where there is no Docker)
FROM debian:12-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends g++ python3-dev python3-venv && rm -rf /var/lib/apt/lists/*
COPY . /source
RUN python3 -m venv /opt/hedon && /opt/hedon/bin/pip install --no-cache-dir "/source[env,remote,rules]"

FROM debian:12-slim
RUN apt-get update && apt-get install -y --no-install-recommends python3 && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/hedon /opt/hedon
ENV PATH=/opt/hedon/bin:$PATH
WORKDIR /data
ENTRYPOINT ["hedon"]
