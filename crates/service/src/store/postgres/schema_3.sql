-- Version 3 of the tables: the name of the key that made a move, where keys were in use.

ALTER TABLE moves ADD COLUMN made_by text;
