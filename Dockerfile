# Build: the toolchain stays behind in this stage.
FROM rust:1.95-bookworm AS build
WORKDIR /src
COPY Cargo.toml Cargo.lock ./
COPY src ./src
COPY benches ./benches
COPY openapi ./openapi
RUN cargo build --locked --profile dist --bin stickslip && mkdir /data

# Run: glibc, no shell, not root.
FROM gcr.io/distroless/cc-debian12:nonroot
COPY --from=build /src/target/dist/stickslip /usr/local/bin/stickslip
COPY --from=build --chown=nonroot:nonroot /data /data
USER nonroot
WORKDIR /data
VOLUME /data
EXPOSE 8080
ENV STICKSLIP_LISTEN=0.0.0.0:8080
HEALTHCHECK --interval=10s --timeout=3s --start-period=2s CMD ["/usr/local/bin/stickslip", "healthcheck"]
ENTRYPOINT ["/usr/local/bin/stickslip"]
CMD ["serve"]
