-- Which of these serial numbers, a JSON array, any unit has.
SELECT DISTINCT serial FROM unit
WHERE serial IN (SELECT jsonb_array_elements_text($1::text::jsonb));
