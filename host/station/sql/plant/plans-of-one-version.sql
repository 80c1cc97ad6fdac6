-- What stations call a plan, where runs were judged by several plans that they call the same.
SELECT product || ' ' || name || ' ' || version FROM plan GROUP BY product, name, version HAVING count(*) > 1;
