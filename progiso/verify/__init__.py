"""Verify images of extreme fields and views: how large their errors are, and their times.

``python -m progiso verify`` prints a row a case. The error of a picture is judged by the caster in
double precision (`progiso.oracle.caster`) over the decoded values, so that compression has no part
in it: see `agreement`. What a case is, is in `case`; the cases are in the modules that `table`
lists.
"""
