-- The statements that hold, by product and name.
SELECT statement, at_ms FROM publication
WHERE number = (
  SELECT max(number) FROM publication AS other WHERE other.product = publication.product AND other.name = publication.name
)
ORDER BY product, name;
