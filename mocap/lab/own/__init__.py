"""A motion graph made of the functions that students write in notebooks 01 to 08, from clips to a walk."""
