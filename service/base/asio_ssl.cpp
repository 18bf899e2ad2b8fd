// Compiles Asio's TLS functions, as cs8_protocol/asio.cpp does the others.
#include <boost/asio/ssl/impl/src.hpp>
