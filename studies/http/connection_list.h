#pragma once

#include <list>
#include <map>
#include <memory>
#include <string>

#include "capstan/http/server.h"

namespace capstan::http {

class Connection;

/// The open connections, oldest first. Where an address, or all together, have too many, the oldest that
/// still waits for its client makes room for a new one: a client that sends its request at once is answered
/// whatever others do.
class ConnectionList {
  public:
    explicit ConnectionList(const ServerLimits& limits) : limits_(limits) {}

    /// False if it is full, because all are being answered.
    bool add(const std::shared_ptr<Connection>& connection);
    void remove(const Connection& connection);

    /// Closes the oldest that waits for its client; of one address, or of any if it is empty.
    bool drop_one(const std::string& address);
    /// Closes each whose time is up.
    void drop_late();
    void drop_all();

  private:
    const ServerLimits& limits_;
    std::list<std::shared_ptr<Connection>> connections_;
    std::map<std::string, std::size_t> of_address_;
};

}  // namespace capstan::http
