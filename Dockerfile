# Build: a static program; the toolchain stays in this stage.
FROM rust:1.95-bookworm@sha256:6258907abe69656e41cd992e0b705cdcfabcbbe3db374f92ed2d47121282d4a1 AS build
RUN apt-get update && apt-get install --yes --no-install-recommends musl-tools ca-certificates
WORKDIR /src
COPY Cargo.toml Cargo.lock LICENSE build.rs image ./
COPY build ./build
COPY .cargo ./.cargo
COPY .ci/libraries ./.ci/
COPY crates ./crates
COPY python/Cargo.toml python/THIRD-PARTY.txt ./python/
COPY python/src ./python/src
COPY src ./src
COPY openapi ./openapi
# The commit that --version and /metrics show: --build-arg BUILD_COMMIT=$(git rev-parse --short=12 HEAD).
ARG BUILD_COMMIT=unknown
RUN ./image /image

# Run: one program, libraries to copy from the image, and the certificates of public authorities. No shell, not root, only the volume is writable.
FROM scratch
COPY --from=build /image /
COPY --from=build --chown=65532:65532 /image/data /data
USER 65532:65532
WORKDIR /data
VOLUME /data
EXPOSE 8080
# Others can reach this address, so the service needs keys. The first start makes one, prints it, and stores its entry in the
# volume. Keys of your own: -v …/keys:/keys:ro -e STICKSLIP_KEYS=/keys. None, in a closed network: -e STICKSLIP_INSECURE=true.
ENV STICKSLIP_LISTEN=0.0.0.0:8080 STICKSLIP_FIRST_KEY=/data/keys
HEALTHCHECK --interval=10s --timeout=3s --start-period=2s CMD ["/stickslip", "healthcheck"]
ENTRYPOINT ["/stickslip"]
CMD ["serve"]
