//! Messages of a SQLite file, read in batches.

use std::collections::{HashMap, VecDeque};

use bytes::Bytes;
use opendr_engine::{Error, Result};
use rusqlite::{Connection, Row};

use super::sqlite_error::sqlite_error;
use crate::compression;
use crate::in_order::Entry;
use crate::recorded::RecordedMessage;
use crate::selection::Filter;

/// Iterator over the selected messages in order.
pub(super) struct Rows {
    database: Connection,
    topics: HashMap<i64, usize>,
    is_zstd: bool,
    order: Order,
    /// Time and row id of the last message read.
    after: (i64, i64),
    bytes: Bytes,
    ready: VecDeque<Entry>,
}

/// How the rows are ordered.
enum Order {
    /// By the time index of rosbag2: SQL that resumes after a time and row id.
    Time(String),
    /// By row id: SQL that resumes after a row id.
    File(String),
    /// Row ids sorted in memory, for a file without the time index.
    Sorted(std::vec::IntoIter<i64>),
}

/// Bytes that are read at a time; a larger message is read alone.
const BATCH_BYTES: usize = 1 << 18;

impl Rows {
    pub fn new(
        database: Connection,
        topics: HashMap<i64, usize>,
        filter: &Filter,
        is_zstd: bool,
    ) -> Result<Self> {
        let mut conditions = String::new();
        if topics.values().any(|channel| !filter.channel(*channel)) {
            let numbers = topics.iter().filter(|(_, channel)| filter.channel(**channel));
            let numbers = numbers.map(|(topic, _)| topic.to_string()).collect::<Vec<_>>().join(",");
            conditions += &format!(" AND topic_id IN ({numbers})");
        }
        let (start, end) = filter.times.clone().into_inner();
        if (start, end) != (i64::MIN, i64::MAX) {
            // The plus prevents SQLite from using an index for the condition.
            conditions += &format!(" AND +timestamp BETWEEN {start} AND {end}");
        }
        let select = "SELECT timestamp, id, topic_id, data FROM messages";
        let order = if filter.in_file_order {
            Order::File(format!("{select} NOT INDEXED WHERE ?1 = ?1 AND id > ?2{conditions} ORDER BY id"))
        } else if has_time_index(&database).map_err(sqlite_error)? {
            let range = format!("timestamp <= {end} AND (timestamp, id) > (?1, ?2)");
            Order::Time(format!("{select} WHERE {range}{conditions} ORDER BY timestamp, id"))
        } else {
            let query = format!("SELECT id FROM messages WHERE id > ?1{conditions} ORDER BY timestamp, id");
            let sorted = || -> rusqlite::Result<Vec<i64>> {
                database.prepare(&query)?.query_map([i64::MIN], |row| row.get(0))?.collect()
            };
            Order::Sorted(sorted().map_err(sqlite_error)?.into_iter())
        };
        let after = if filter.in_file_order { i64::MIN } else { start };
        let after = (after, i64::MIN);
        let (bytes, ready) = (Bytes::new(), VecDeque::new());
        Ok(Self { database, topics, is_zstd, order, after, bytes, ready })
    }

    /// Reads the next batch. At the end, no message is ready afterwards.
    fn fill(&mut self) -> Result<()> {
        let (bytes, entries) = Default::default();
        let mut batch =
            Batch { topics: &self.topics, is_zstd: self.is_zstd, after: self.after, bytes, entries };
        match &mut self.order {
            Order::Time(query) | Order::File(query) => {
                let mut messages = self.database.prepare_cached(query).map_err(sqlite_error)?;
                let mut rows = messages.query(self.after).map_err(sqlite_error)?;
                while batch.bytes.len() < BATCH_BYTES
                    && let Some(row) = rows.next().map_err(sqlite_error)?
                {
                    batch.add(row)?;
                }
            }
            Order::Sorted(ids) => {
                let query = "SELECT timestamp, id, topic_id, data FROM messages WHERE id = ?1";
                let mut message = self.database.prepare_cached(query).map_err(sqlite_error)?;
                while batch.bytes.len() < BATCH_BYTES
                    && let Some(id) = ids.next()
                {
                    let mut rows = message.query([id]).map_err(sqlite_error)?;
                    while let Some(row) = rows.next().map_err(sqlite_error)? {
                        batch.add(row)?;
                    }
                }
            }
        }
        self.after = batch.after;
        self.bytes = batch.bytes.into();
        self.ready = batch.entries;
        Ok(())
    }
}

impl Iterator for Rows {
    type Item = Result<RecordedMessage>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ready.is_empty()
            && let Err(error) = self.fill()
        {
            return Some(Err(error));
        }
        let Entry { log_time_ns, publish_time_ns, channel, start, end } = self.ready.pop_front()?;
        let bytes = self.bytes.slice(start..end);
        Some(Ok(RecordedMessage { channel: channel as usize, log_time_ns, publish_time_ns, bytes }))
    }
}

/// Messages that are read at a time.
struct Batch<'a> {
    topics: &'a HashMap<i64, usize>,
    is_zstd: bool,
    after: (i64, i64),
    bytes: Vec<u8>,
    entries: VecDeque<Entry>,
}

impl Batch<'_> {
    fn add(&mut self, row: &Row) -> Result<()> {
        let place = || -> rusqlite::Result<(i64, i64, i64)> { Ok((row.get(0)?, row.get(1)?, row.get(2)?)) };
        let (log_time_ns, id, topic) = place().map_err(sqlite_error)?;
        self.after = (log_time_ns, id);
        let Some(&channel) = self.topics.get(&topic) else { return Ok(()) };
        let data = row.get_ref(3).map_err(sqlite_error)?;
        let data = data.as_bytes().map_err(|error| {
            Error::format(format!("the data of message {id} is not a blob")).with_source(error)
        })?;
        let start = self.bytes.len();
        if self.is_zstd {
            self.bytes.extend_from_slice(&compression::zstd(data, None)?);
        } else {
            self.bytes.extend_from_slice(data);
        }
        let (channel, end) = (channel as u32, self.bytes.len());
        self.entries.push_back(Entry { log_time_ns, publish_time_ns: None, channel, start, end });
        Ok(())
    }
}

fn has_time_index(database: &Connection) -> rusqlite::Result<bool> {
    let query = "SELECT COUNT(*) FROM pragma_index_list('messages') AS list, pragma_index_info(list.name) AS info \
                 WHERE info.seqno = 0 AND info.name = 'timestamp' AND list.partial = 0";
    Ok(database.query_row(query, [], |row| row.get::<_, i64>(0))? > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sorting the remaining rows for every batch took minutes for a recording of 1 GB.
    #[test]
    fn no_batch_is_sorted() {
        let filter = Filter { channels: vec![true, false], times: i64::MIN..=i64::MAX, in_file_order: false };
        let in_time = Filter { times: 5..=i64::MAX - 1, ..filter.clone() };
        for filter in [filter, in_time] {
            for in_file_order in [false, true] {
                let database = Connection::open_in_memory().unwrap();
                database
                    .execute_batch(
                        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);
                         CREATE INDEX timestamp_idx ON messages (timestamp ASC)",
                    )
                    .unwrap();
                let topics = HashMap::from([(1, 0), (2, 1)]);
                let rows =
                    Rows::new(database, topics, &Filter { in_file_order, ..filter.clone() }, false).unwrap();
                let (Order::Time(query) | Order::File(query)) = &rows.order else { panic!("sorted here") };
                let mut plan = rows.database.prepare(&format!("EXPLAIN QUERY PLAN {query}")).unwrap();
                let steps = plan.query_map(rows.after, |row| row.get::<_, String>("detail")).unwrap();
                let steps: Vec<_> = steps.map(Result::unwrap).collect();
                assert!(steps.iter().any(|step| step.starts_with("SEARCH messages")), "{steps:?}");
                assert!(!steps.iter().any(|step| step.contains("ORDER BY")), "{steps:?}");
            }
        }
    }
}
