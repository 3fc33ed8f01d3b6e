-- Version 1 of the tables; `docs/postgres.md` explains the columns. Once released it is frozen: what comes later is a script
-- of its own. Quantities are in SI units. A column `..._ns` has the nanoseconds beyond the microseconds of its timestamp.

CREATE TABLE contacts (
    id uuid PRIMARY KEY,
    label text,
    tenant text NOT NULL,
    definition text NOT NULL,
    sequence bigint NOT NULL,
    created_at timestamptz NOT NULL,
    created_ns smallint NOT NULL,
    updated_at timestamptz NOT NULL,
    updated_ns smallint NOT NULL
);
CREATE INDEX contacts_by_tenant ON contacts (tenant, id);

-- There is no foreign key to `contacts`: moves are only inserted with an update of their contact that has succeeded.
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

-- Replies that retries get again.
CREATE TABLE receipts (
    key text PRIMARY KEY,
    fingerprint bytea NOT NULL,
    created uuid,
    sequence bigint NOT NULL,
    body bytea NOT NULL,
    created_at timestamptz NOT NULL DEFAULT now()
);
CREATE INDEX receipts_created_at ON receipts (created_at);

-- Packed states for a replay to begin at.
CREATE TABLE snapshots (
    contact uuid PRIMARY KEY REFERENCES contacts (id) ON DELETE CASCADE,
    sequence bigint NOT NULL,
    state bytea NOT NULL
);

-- Contacts that have expired.
CREATE TABLE expired (
    id uuid PRIMARY KEY,
    tenant text NOT NULL,
    at timestamptz NOT NULL DEFAULT now()
);

-- Jobs, and the chunks that they are done in.
CREATE TABLE jobs (
    id uuid PRIMARY KEY,
    tenant text NOT NULL,
    created_at timestamptz NOT NULL,
    created_ns smallint NOT NULL,
    finished_at timestamptz,
    error text,
    points bigint NOT NULL,
    chunk bigint NOT NULL,
    done bigint NOT NULL,
    failed bigint NOT NULL,
    bytes bigint NOT NULL,
    cost bigint NOT NULL,
    request text NOT NULL
);
CREATE INDEX jobs_by_tenant ON jobs (tenant);
CREATE TABLE job_chunks (
    job uuid NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    chunk bigint NOT NULL,
    owner uuid,
    leased_until timestamptz,
    content bytea,
    PRIMARY KEY (job, chunk)
);
CREATE INDEX job_chunks_open ON job_chunks (job, chunk) WHERE content IS NULL;
