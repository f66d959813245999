//! Messages of a SQLite file, as many at a time as make a chunk.

use std::collections::{HashMap, VecDeque};

use bytes::Bytes;
use opendr_engine::{Error, Result};
use rusqlite::{Connection, Row};

use super::sqlite::refused;
use crate::compression;
use crate::in_order::Entry;
use crate::recorded::Recorded;
use crate::selection::Wanted;

/// The wanted messages in order.
pub(super) struct Rows {
    database: Connection,
    topics: HashMap<i64, usize>,
    is_zstd: bool,
    order: Order,
    /// The time and row of the last message read.
    after: (i64, i64),
    bytes: Bytes,
    ready: VecDeque<Entry>,
}

/// Where the order comes from.
enum Order {
    /// The index by time that rosbag2 makes: SQL that goes on after a time and row.
    Time(String),
    /// The table: likewise.
    File(String),
    /// Rows that were sorted here, since the index is missing.
    Sorted(std::vec::IntoIter<i64>),
}

/// About so many bytes are read at a time, or one larger message.
const BATCH: usize = 1 << 18;

impl Rows {
    pub fn new(
        database: Connection,
        topics: HashMap<i64, usize>,
        wanted: &Wanted,
        is_zstd: bool,
    ) -> Result<Self> {
        let mut only = String::new();
        if topics.values().any(|channel| !wanted.channel(*channel)) {
            let numbers = topics.iter().filter(|(_, channel)| wanted.channel(**channel));
            let numbers = numbers.map(|(topic, _)| topic.to_string()).collect::<Vec<_>>().join(",");
            only += &format!(" AND topic_id IN ({numbers})");
        }
        let (start, end) = wanted.times.clone().into_inner();
        if (start, end) != (i64::MIN, i64::MAX) {
            // The plus keeps SQLite from choosing an index for it.
            only += &format!(" AND +timestamp BETWEEN {start} AND {end}");
        }
        let select = "SELECT timestamp, id, topic_id, data FROM messages";
        let order = if wanted.in_file_order {
            Order::File(format!("{select} NOT INDEXED WHERE ?1 = ?1 AND id > ?2{only} ORDER BY id"))
        } else if has_time_index(&database).map_err(refused)? {
            let range = format!("timestamp <= {end} AND (timestamp, id) > (?1, ?2)");
            Order::Time(format!("{select} WHERE {range}{only} ORDER BY timestamp, id"))
        } else {
            let query = format!("SELECT id FROM messages WHERE id > ?1{only} ORDER BY timestamp, id");
            let sorted = || -> rusqlite::Result<Vec<i64>> {
                database.prepare(&query)?.query_map([i64::MIN], |row| row.get(0))?.collect()
            };
            Order::Sorted(sorted().map_err(refused)?.into_iter())
        };
        let after = if wanted.in_file_order { i64::MIN } else { start };
        let after = (after, i64::MIN);
        let (bytes, ready) = (Bytes::new(), VecDeque::new());
        Ok(Self { database, topics, is_zstd, order, after, bytes, ready })
    }

    /// Reads the next messages; none are ready afterwards at the end.
    fn fill(&mut self) -> Result<()> {
        let (bytes, entries) = Default::default();
        let mut batch =
            Batch { topics: &self.topics, is_zstd: self.is_zstd, after: self.after, bytes, entries };
        match &mut self.order {
            Order::Time(query) | Order::File(query) => {
                let mut messages = self.database.prepare_cached(query).map_err(refused)?;
                let mut rows = messages.query(self.after).map_err(refused)?;
                while batch.bytes.len() < BATCH
                    && let Some(row) = rows.next().map_err(refused)?
                {
                    batch.add(row)?;
                }
            }
            Order::Sorted(ids) => {
                let query = "SELECT timestamp, id, topic_id, data FROM messages WHERE id = ?1";
                let mut message = self.database.prepare_cached(query).map_err(refused)?;
                while batch.bytes.len() < BATCH
                    && let Some(id) = ids.next()
                {
                    let mut rows = message.query([id]).map_err(refused)?;
                    while let Some(row) = rows.next().map_err(refused)? {
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
    type Item = Result<Recorded>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ready.is_empty()
            && let Err(error) = self.fill()
        {
            return Some(Err(error));
        }
        let Entry { log_time_ns, publish_time_ns, channel, start, end } = self.ready.pop_front()?;
        let bytes = self.bytes.slice(start..end);
        Some(Ok(Recorded { channel: channel as usize, log_time_ns, publish_time_ns, bytes }))
    }
}

/// Messages read at a time.
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
        let (log_time_ns, id, topic) = place().map_err(refused)?;
        self.after = (log_time_ns, id);
        let Some(&channel) = self.topics.get(&topic) else { return Ok(()) };
        let data = row.get_ref(3).map_err(refused)?;
        let data = data.as_bytes().map_err(|error| {
            Error::format(format!("the data of message {id} is no blob")).with_source(error)
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

    /// Sorting whatever is left for every batch made a recording of 1 GB take minutes.
    #[test]
    fn no_batch_is_sorted() {
        let wanted = Wanted { channels: vec![true, false], times: i64::MIN..=i64::MAX, in_file_order: false };
        let in_time = Wanted { times: 5..=i64::MAX - 1, ..wanted.clone() };
        for wanted in [wanted, in_time] {
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
                    Rows::new(database, topics, &Wanted { in_file_order, ..wanted.clone() }, false).unwrap();
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
