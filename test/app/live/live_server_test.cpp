// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_server.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <optional>
#include <thread>

#include "io/error.hpp"
#include "reason_of.hpp"

namespace photonav {
namespace {

int portOf(const LiveServer& server) {
    const std::string url = server.url();
    return std::stoi(url.substr(url.rfind(':') + 1));
}

/// All that a browser gets at /events until the server ends, or `stop` says that it has enough.
std::string eventsOf(int port, const httplib::Headers& headers = {},
                     const std::function<bool(const std::string&)>& stop = {}) {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(20);
    std::string text;
    client.Get("/events", headers, [&](const char* bytes, std::size_t count) {
        text.append(bytes, count);
        return !stop || !stop(text);
    });
    return text;
}

std::size_t countOf(const std::string& part, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
    return count;
}

TEST(ServerAddress, IsAPortOrAnAddressWithOne) {
    EXPECT_EQ(parseServerAddress("8080").host, "127.0.0.1");
    EXPECT_EQ(parseServerAddress("8080").port, 8080);
    EXPECT_EQ(parseServerAddress("0.0.0.0:65535").host, "0.0.0.0");
    EXPECT_EQ(parseServerAddress("[::1]:80").host, "::1");
    EXPECT_EQ(parseServerAddress("[::1]:80").port, 80);
    for (const char* bad :
         {"", "x", "80x", ":80", "host:", "-1", "::1:80", "1 2", "[::1", "[::1:80", "::1]:80"}) {
        EXPECT_THROW(parseServerAddress(bad), InputError) << bad;
    }
    for (const char* large : {"65536", "host:99999999999999999999"}) {
        const std::string reason = test::reasonOf([&] { parseServerAddress(large); });
        EXPECT_NE(reason.find("not between 0 and 65535"), std::string::npos) << reason;
    }
}

TEST(LiveServer, GivesThePageAndAllEventsWhenOneComesLate) {
    std::optional<LiveServer> server(std::in_place, ServerAddress{}, "<html>page</html>");
    const int port = portOf(*server);
    server->publish("moment", R"({"n":0})");
    std::string early, late;
    std::thread first([&] { early = eventsOf(port); });
    httplib::Client client("127.0.0.1", port);
    const auto page = client.Get("/");
    ASSERT_TRUE(page);
    EXPECT_EQ(page->body, "<html>page</html>");
    EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
    EXPECT_EQ(client.Get("/other")->status, 404);
    server->publish("moment", R"({"n":1})");
    std::thread second([&] { late = eventsOf(port, {{"Last-Event-ID", "0"}}); });
    // Both are connected before the server ends: they have got the event.
    eventsOf(port, {}, [](const std::string& text) { return countOf("data:", text) == 2; });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    server->publish("end", "{}");
    server.reset();
    first.join();
    second.join();
    EXPECT_EQ(early,
              "event: moment\nid: 0\ndata: {\"n\":0}\n\nevent: moment\nid: 1\ndata: {\"n\":1}\n\n"
              "event: end\nid: 2\ndata: {}\n\n");
    EXPECT_EQ(late, "event: moment\nid: 1\ndata: {\"n\":1}\n\nevent: end\nid: 2\ndata: {}\n\n");
}

TEST(LiveServer, APortInUseIsNamed) {
    const LiveServer server({}, "page");
    const int port = portOf(server);
    const std::string reason = test::reasonOf([&] { LiveServer({"127.0.0.1", port}, "page"); });
    EXPECT_EQ(reason, fmt::format("--serve: 127.0.0.1:{}: the port is in use", port));
    EXPECT_THROW(LiveServer({"192.0.2.1", 8080}, "page"), InputError);  // of no interface here
    EXPECT_THROW(LiveServer({"no.such.host.invalid", 8080}, "page"), InputError);
}

/// A socket that asks for the events, and may never read them.
class SilentBrowser {
  public:
    explicit SilentBrowser(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        const std::string request = "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n";
        EXPECT_EQ(send(socket_, request.data(), request.size(), 0),
                  static_cast<ssize_t>(request.size()));
    }
    SilentBrowser(const SilentBrowser&) = delete;
    SilentBrowser& operator=(const SilentBrowser&) = delete;
    ~SilentBrowser() { close(socket_); }

  private:
    int socket_;
};

TEST(LiveServer, ABrowserThatReadsNothingOrLeavesDelaysNobody) {
    LiveServer server({}, "page");
    const int port = portOf(server);
    const SilentBrowser silent(port);
    { const SilentBrowser left(port); }
    const std::string large(1U << 20U, 'x');  // more in all than sockets hold
    for (int i = 0; i < 20; ++i) server.publish("moment", large);
    // To count in all of the text again and again would take longer than the server waits.
    const std::string got = eventsOf(port, {}, [&](const std::string& text) {
        return text.size() > 20 * large.size() && text.ends_with("\n\n");
    });
    EXPECT_EQ(countOf("event: moment", got), 20U);
}

TEST(LiveServer, KeepsNothingOfWhatIsSentToIt) {
    const LiveServer server(ServerAddress{}, "page");
    httplib::Client client("127.0.0.1", portOf(server));
    const std::string large(1U << 20U, 'x');
    for (const char* path : {"/", "/events", "/none"}) {
        const auto answer = client.Post(path, large, "text/plain");
        ASSERT_TRUE(answer) << path;
        EXPECT_GE(answer->status, 400) << path;
    }
    const auto chunked = client.Post(
        "/",
        [&](std::size_t offset, httplib::DataSink& sink) {
            if (offset >= 10 * large.size()) {
                sink.done();
                return true;
            }
            return sink.write(large.data(), large.size());
        },
        "text/plain");
    ASSERT_TRUE(chunked);
    EXPECT_EQ(chunked->status, 405);
    EXPECT_EQ(client.Get("/")->body, "page");
}

TEST(LiveServer, OnLoopbackOtherHostsAreRefused) {
    const LiveServer server({}, "page");
    httplib::Client client("127.0.0.1", portOf(server));
    EXPECT_EQ(client.Get("/", {{"Host", "elsewhere.example"}})->status, 403);
    EXPECT_EQ(client.Get("/", {{"Host", "localhost:1"}})->status, 200);
}

}  // namespace
}  // namespace photonav
