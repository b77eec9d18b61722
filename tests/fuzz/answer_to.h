#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>

namespace capstan::fuzz {

/// Everything that a server on this port of the machine answers to these bytes, after which the client sends
/// no more.
inline std::string answer_to(const std::string& request, int port) {
    const int connection = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string answer;
    if (::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        for (std::size_t sent = 0; sent < request.size();) {
            const ssize_t now =
                ::send(connection, request.data() + sent, request.size() - sent, MSG_NOSIGNAL);
            if (now <= 0) break;
            sent += static_cast<std::size_t>(now);
        }
        ::shutdown(connection, SHUT_WR);
        std::array<char, 65536> buffer;
        for (ssize_t now = 0; (now = ::recv(connection, buffer.data(), buffer.size(), 0)) > 0;)
            answer.append(buffer.data(), static_cast<std::size_t>(now));
    }
    ::close(connection);
    return answer;
}

}  // namespace capstan::fuzz
