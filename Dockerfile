# Stillpoint from its packages: `docker build -t stillpoint .`, then
#   docker run --rm -v "$PWD:/data" -w /data stillpoint run stillpoint --dataset DIR -o OUT
# Other programs, such as stillpoint-get-models, are named with --entrypoint: docs/quickstart.md.
FROM debian:bookworm-slim AS build
COPY . /stillpoint
WORKDIR /stillpoint
RUN apt-get update && apt-get install -y --no-install-recommends git && tools/setup \
 && cmake --preset release -DSTILLPOINT_BUILD_TESTS=OFF \
 && cmake --build --preset release \
 && cpack --config build/release/CPackConfig.cmake

FROM debian:bookworm-slim
COPY --from=build /stillpoint/build/release/packages/*.deb /packages/
RUN apt-get update \
 && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
      /packages/*.deb libgtest-dev nlohmann-json3-dev curl ca-certificates \
 && rm -rf /var/lib/apt/lists/* /packages
ENTRYPOINT ["stillpoint"]
