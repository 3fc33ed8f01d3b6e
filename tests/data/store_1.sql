-- A store as version 1 wrote it; frozen. Two sessions, the first with three moves (one of them to minus nought), and a reply
-- kept for retries. The test makes a file of it.
PRAGMA application_id = 1937007467;
PRAGMA user_version = 1;
CREATE TABLE contacts (
    number INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    label TEXT,
    created_at INTEGER NOT NULL,
    initial_updated_at INTEGER NOT NULL,
    inherited INTEGER NOT NULL,
    definition TEXT NOT NULL
) STRICT;
CREATE TABLE moves (
    contact INTEGER NOT NULL,
    sequence INTEGER NOT NULL,
    at INTEGER NOT NULL,
    to_displacement REAL,
    to_force REAL,
    to_indentation REAL,
    to_normal_force REAL,
    relative INTEGER NOT NULL,
    tolerance REAL NOT NULL,
    displacement REAL NOT NULL,
    force REAL NOT NULL,
    indentation REAL NOT NULL,
    normal_force REAL NOT NULL,
    contact_radius REAL NOT NULL,
    stick_radius REAL NOT NULL,
    regime TEXT NOT NULL,
    dissipated_energy REAL NOT NULL,
    elastic_energy REAL NOT NULL,
    memory_depth INTEGER NOT NULL,
    negative_zeros INTEGER NOT NULL,
    PRIMARY KEY (contact, sequence)
) STRICT, WITHOUT ROWID;
CREATE TABLE receipts (
    number INTEGER PRIMARY KEY,
    key TEXT NOT NULL UNIQUE,
    fingerprint BLOB NOT NULL,
    created TEXT,
    sequence INTEGER NOT NULL,
    body BLOB NOT NULL,
    at INTEGER NOT NULL
) STRICT;
INSERT INTO contacts VALUES
(1, '0199c0de-0000-7000-8000-000000000001', 'old', 1760000000000000001, 1760000000000000001, 0, '{"profile":{"type":"sphere","radius":0.01},"material":{"bodies":[{"youngs_modulus":210000000000.0,"poisson_ratio":0.3},"rigid"]},"friction":0.3,"preload":{"normal_force":10.0}}'),
(2, '0199c0de-0000-7000-8000-000000000002', NULL, 1760000001000000000, 1760000002000000000, 0, '{"profile":{"type":"cone","slope":0.1},"material":{"effective":{"e_star":1000.0,"g_star":1000.0}},"friction":0.0,"preload":{"indentation":0.0}}');
INSERT INTO moves VALUES
(1, 1, 1760000003000000007, 1e-7, NULL, NULL, NULL, 0, 1e-10, 1e-7, 0.5, 4.7e-7, 10.0, 6.8e-5, 5e-5, 'partial_slip', 1e-9, 2e-8, 2, 0),
(1, 2, 1760000004000000000, NULL, 0.0, NULL, NULL, 0, 1e-10, 3e-9, 0.0, 4.7e-7, 10.0, 6.8e-5, 5e-5, 'partial_slip', 2e-9, 1e-9, 3, 2),
(1, 3, 1760000005123456789, NULL, NULL, -1e-8, NULL, 1, 1e-10, 3e-9, 0.0, 4.6e-7, 9.7, 6.7e-5, 0.0, 'gross_slip', 3e-9, 0.0, 1, 0);
INSERT INTO receipts (key, fingerprint, created, sequence, body, at) VALUES
('kept', x'0707070707070707070707070707070707070707070707070707070707070707', NULL, 3, x'7b7d', 4000000000000000000);
