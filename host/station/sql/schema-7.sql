-- What is to be sent without a word of a person's; what waits for one stands in front of it, and may be all that was ever kept.
CREATE INDEX outbox_due ON outbox (sink, subject) WHERE done_ms IS NULL AND dead_ms IS NULL;
