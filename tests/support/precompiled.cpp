// Nothing of its own: the header that the tests share is compiled with this file.
