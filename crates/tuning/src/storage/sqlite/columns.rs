//! Column names of a table, from its definition.

/// Keywords of parts of a definition that are not columns.
const CONSTRAINTS: [&str; 5] = ["CONSTRAINT", "PRIMARY", "UNIQUE", "CHECK", "FOREIGN"];

/// Returns the columns of `CREATE TABLE name (a INTEGER NOT NULL, "b" VARCHAR(512), PRIMARY KEY (a))`, in order.
pub fn columns_from_sql(sql: &str) -> Option<Vec<String>> {
    let (_, body) = sql.split_once('(')?;
    let (body, _) = body.rsplit_once(')')?;
    let mut depth = 0i32;
    let parts = body.split(|character| {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        character == ',' && depth == 0
    });
    let first_words = parts.map(|part| part.split_whitespace().next().unwrap_or_default());
    let columns = first_words.filter(|word| !CONSTRAINTS.contains(&word.to_ascii_uppercase().as_str()));
    Some(columns.map(|word| word.trim_matches(['"', '`', '[', ']']).to_owned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_distinguished_from_constraints() {
        let sql = "CREATE TABLE t (\n\ta INTEGER NOT NULL, \n\t\"b\" VARCHAR(8), c VARCHAR(7) DEFAULT (1, 2) NOT NULL, \n\t\
                   PRIMARY KEY (a, b), UNIQUE (b), FOREIGN KEY(b) REFERENCES u (b), CONSTRAINT x CHECK (a IN (1, 2))\n)";
        assert_eq!(columns_from_sql(sql).unwrap(), ["a", "b", "c"]);
        assert_eq!(columns_from_sql("CREATE TABLE t"), None);
    }
}
