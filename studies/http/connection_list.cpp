#include "capstan/http/connection_list.h"

#include <algorithm>

#include "capstan/http/connection.h"

namespace capstan::http {

bool ConnectionList::drop_one(const std::string& address) {
    const auto oldest = std::ranges::find_if(connections_, [&](const auto& each) {
        return each->waits_for_client() && (address.empty() || each->address() == address);
    });
    if (oldest == connections_.end()) return false;
    const std::shared_ptr<Connection> kept = *oldest;
    kept->close();
    return true;
}

bool ConnectionList::add(const std::shared_ptr<Connection>& connection) {
    const std::string& address = connection->address();
    if (of_address_[address] >= limits_.connections_of_one_address && !drop_one(address)) return false;
    if (connections_.size() >= limits_.connections && !drop_one("")) return false;
    connections_.push_back(connection);
    ++of_address_[address];
    return true;
}

void ConnectionList::remove(const Connection& connection) {
    const auto found =
        std::ranges::find_if(connections_, [&](const auto& each) { return each.get() == &connection; });
    if (found == connections_.end()) return;
    if (--of_address_[connection.address()] == 0) of_address_.erase(connection.address());
    connections_.erase(found);
}

void ConnectionList::drop_late() {
    const auto now = Connection::Clock::now();
    std::vector<std::shared_ptr<Connection>> late;
    std::ranges::copy_if(connections_, std::back_inserter(late),
                         [&](const auto& each) { return each->is_late(now); });
    for (const auto& each : late) each->close();
}

void ConnectionList::drop_all() {
    const std::vector<std::shared_ptr<Connection>> all(connections_.begin(), connections_.end());
    for (const auto& each : all) each->close();
}

}  // namespace capstan::http
