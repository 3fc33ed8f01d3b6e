-- A database as version 1 of the tables was; frozen. One session with a move, one that has expired, and a reply kept for
-- retries.
CREATE TABLE stickslip_schema (
    version integer PRIMARY KEY,
    applied_at timestamptz NOT NULL DEFAULT now()
);
INSERT INTO stickslip_schema (version) VALUES (1);
CREATE TABLE contacts (
    id uuid PRIMARY KEY,
    label text,
    definition text NOT NULL,
    sequence bigint NOT NULL,
    created_at timestamptz NOT NULL,
    created_ns smallint NOT NULL,
    updated_at timestamptz NOT NULL,
    updated_ns smallint NOT NULL
);
CREATE TABLE moves (
    contact uuid NOT NULL,
    sequence bigint NOT NULL,
    target_displacement double precision,
    target_force double precision,
    target_indentation double precision,
    target_normal_force double precision,
    relative boolean NOT NULL,
    tolerance double precision NOT NULL,
    displacement double precision NOT NULL,
    force double precision NOT NULL,
    indentation double precision NOT NULL,
    normal_force double precision NOT NULL,
    contact_radius double precision NOT NULL,
    stick_radius double precision NOT NULL,
    regime text NOT NULL,
    dissipated_energy double precision NOT NULL,
    elastic_energy double precision NOT NULL,
    memory_depth bigint NOT NULL,
    at timestamptz NOT NULL,
    at_ns smallint NOT NULL,
    stamp bigint NOT NULL,
    PRIMARY KEY (contact, sequence)
);
CREATE TABLE receipts (
    key text PRIMARY KEY,
    fingerprint bytea NOT NULL,
    created uuid,
    sequence bigint NOT NULL,
    body bytea NOT NULL,
    created_at timestamptz NOT NULL DEFAULT now()
);
CREATE INDEX receipts_created_at ON receipts (created_at);
CREATE TABLE snapshots (
    contact uuid PRIMARY KEY REFERENCES contacts (id) ON DELETE CASCADE,
    sequence bigint NOT NULL,
    state bytea NOT NULL
);
CREATE TABLE expired (
    id uuid PRIMARY KEY,
    at timestamptz NOT NULL DEFAULT now()
);
INSERT INTO contacts VALUES
('0199c0de-0000-7000-8000-000000000001', 'old', '{"profile":{"type":"sphere","radius":0.01},"material":{"bodies":[{"youngs_modulus":210000000000.0,"poisson_ratio":0.3},"rigid"]},"friction":0.3,"preload":{"normal_force":10.0}}', 1, '2025-10-09T08:53:20Z', 1, '2025-10-09T08:53:23Z', 7);
INSERT INTO moves VALUES
('0199c0de-0000-7000-8000-000000000001', 1, 1e-7, NULL, NULL, NULL, false, 1e-10, 1e-7, 0.5, 4.7e-7, 10.0, 6.8e-5, 5e-5, 'partial_slip', 1e-9, 2e-8, 2, '2025-10-09T08:53:23Z', 7, 11);
INSERT INTO receipts (key, fingerprint, created, sequence, body) VALUES
('kept', '\x0707070707070707070707070707070707070707070707070707070707070707', NULL, 1, '\x7b7d');
INSERT INTO expired (id) VALUES ('0199c0de-0000-7000-8000-000000000002');
