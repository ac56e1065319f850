"""Statistics: functions of arrays that know no run, no file and no world. One method per file."""
