// The one place where Asio's own TLS functions are compiled, beside cs8_protocol/asio.cpp.
#include <boost/asio/ssl/impl/src.hpp>
