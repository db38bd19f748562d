// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <deque>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "io/error.hpp"

namespace photonav {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostStreams = 24;  // each has a thread; others fetch pages meanwhile
constexpr std::size_t kThreads = kMostStreams + 8;
constexpr auto kHeartbeat = 5s;  // so that the thread of a browser that left is free again
constexpr auto kFarewell = 2s;
constexpr int kLargestPort = 65535;
constexpr std::array kLoopback{"127.0.0.1", "localhost", "::1"};

bool isLoopback(const std::string& host) {
    return std::find(kLoopback.begin(), kLoopback.end(), host) != kLoopback.end();
}

/// The host of "host:port" or "[host]:port".
std::string hostOf(const std::string& text) {
    const std::string host = text.ends_with(']') ? text : text.substr(0, text.rfind(':'));
    return host.starts_with('[') && host.ends_with(']') ? host.substr(1, host.size() - 2) : host;
}

/// Unlike the library's default: without SO_REUSEPORT, with which two servers share a port.
void reuseAddress(socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

/// Threads that start meanwhile take no signals: those are for the flight, and must not interrupt
/// accept().
class NoSignals {
  public:
    NoSignals() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~NoSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    NoSignals(const NoSignals&) = delete;
    NoSignals& operator=(const NoSignals&) = delete;

  private:
    sigset_t before_;
};

/// The threads of the server, which start before it does: a program that may have no more of them
/// can still say so. (The library's own pool would end it.)
class Threads : public httplib::TaskQueue {
  public:
    /// @throws InputError when the system does not start them
    explicit Threads(std::size_t count) {
        try {
            while (threads_.size() < count) threads_.emplace_back([this] { work(); });
        } catch (const std::system_error&) {
            shutdown();
            throw InputError("--serve", "", "the system starts no more threads (ulimit -u)");
        }
    }

    void enqueue(std::function<void()> job) override {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
        changed_.notify_one();
    }

    void shutdown() override {
        {
            const std::lock_guard lock(mutex_);
            isEnding_ = true;
            changed_.notify_all();
        }
        for (std::thread& thread : threads_) thread.join();
        threads_.clear();
    }

  private:
    void work() {
        for (std::unique_lock lock(mutex_);; lock.lock()) {
            changed_.wait(lock, [this] { return isEnding_ || !jobs_.empty(); });
            if (jobs_.empty()) return;
            const std::function<void()> job = std::move(jobs_.front());
            jobs_.pop_front();
            lock.unlock();
            job();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;
    bool isEnding_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace

ServerAddress parseServerAddress(const std::string& text) {
    const auto refuse = [&](const std::string& reason) {
        throw InputError("--serve", text, reason);
    };
    ServerAddress address;
    std::string port = text;
    if (const std::size_t colon = text.rfind(':'); colon != std::string::npos) {
        address.host = hostOf(text);
        port = text.substr(colon + 1);
        const bool isPlain = address.host.find(':') == std::string::npos;
        const bool isBracketed = text.starts_with('[') && !address.host.starts_with('[');
        if (address.host.empty() || (!isPlain && !isBracketed)) {
            refuse("is not PORT, ADDRESS:PORT or [IPV6]:PORT");
        }
    }
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error == std::errc::invalid_argument || end != port.data() + port.size()) {
        refuse("is not PORT, ADDRESS:PORT or [IPV6]:PORT");
    }
    if (error != std::errc{} || address.port < 0 || address.port > kLargestPort) {
        refuse("the port is not between 0 and 65535");
    }
    return address;
}

class LiveServer::Implementation {
  public:
    Implementation(const ServerAddress& address, std::string page)
        : address_(address), page_(std::move(page)) {
        server_.new_task_queue = [this] { return threads_.release(); };
        server_.set_socket_options(reuseAddress);
        server_.set_keep_alive_timeout(1);
        server_.set_read_timeout(kFarewell / 2);
        server_.set_write_timeout(kFarewell);
        server_.set_default_headers(
            {{"Cache-Control", "no-store"}, {"X-Content-Type-Options", "nosniff"}});
        if (isLoopback(address_.host)) refuseOtherHosts();
        discardUploads();
        server_.Get("/", [this](const httplib::Request&, httplib::Response& response) {
            response.set_content(page_, "text/html; charset=utf-8");
        });
        server_.Get("/events", [this](const httplib::Request& request,
                                      httplib::Response& response) { stream(request, response); });
        bind();
        startThread();
        while (!server_.is_running()) std::this_thread::sleep_for(1ms);
    }

    ~Implementation() {
        {
            std::unique_lock lock(mutex_);
            isClosing_ = true;
            changed_.notify_all();
            changed_.wait_for(lock, kFarewell, [&] { return streams_ == 0; });
        }
        server_.stop();
        thread_.join();
    }

    void publish(std::string_view name, std::string_view data) {
        const std::lock_guard lock(mutex_);
        events_.push_back(std::make_shared<const std::string>(
            fmt::format("event: {}\nid: {}\ndata: {}\n\n", name, events_.size(), data)));
        changed_.notify_all();
    }

    std::string url() const {
        const bool isPlain = address_.host.find(':') == std::string::npos;
        return fmt::format(fmt::runtime(isPlain ? "http://{}:{}/" : "http://[{}]:{}/"),
                           address_.host, address_.port);
    }

  private:
    /// One browser that listens.
    struct Stream {
        explicit Stream(Implementation& server) : of(server) {}
        Stream(const Stream&) = delete;
        Stream& operator=(const Stream&) = delete;
        ~Stream() {
            const std::lock_guard lock(of.mutex_);
            --of.streams_;
            of.changed_.notify_all();
        }
        Implementation& of;
        std::size_t next = 0;  // event
    };

    void bind() {
        errno = 0;
        const bool isAny = address_.port == 0;
        if (isAny) address_.port = server_.bind_to_any_port(address_.host);
        if (isAny ? address_.port > 0 : server_.bind_to_port(address_.host, address_.port)) return;
        const int error = errno;
        const std::string reason = error == EADDRINUSE ? "the port is in use"
                                   : error == 0        ? "no such address"
                                                       : std::strerror(error);
        throw InputError("--serve", fmt::format("{}:{}", address_.host, std::max(0, address_.port)),
                         reason);
    }

    void startThread() {
        const NoSignals none;
        threads_ = std::make_unique<Threads>(kThreads);
        thread_ = std::thread([this] { server_.listen_after_bind(); });
    }

    /// Pages of other hosts, for which a browser would fetch what only this machine may see.
    void refuseOtherHosts() {
        server_.set_pre_routing_handler(
            [](const httplib::Request& request, httplib::Response& response) {
                const bool isRead = request.method == "GET" || request.method == "HEAD";
                if (!isRead || isLoopback(hostOf(request.get_header_value("Host")))) {
                    return httplib::Server::HandlerResponse::Unhandled;
                }
                response.status = 403;
                return httplib::Server::HandlerResponse::Handled;
            });
    }

    /// What is sent is read, as the protocol demands, but not kept.
    void discardUploads() {
        server_.set_payload_max_length(0);
        const auto discard = [](const httplib::Request&, httplib::Response& response,
                                const httplib::ContentReader& read) {
            read([](const char*, std::size_t) { return true; });
            response.status = 405;
        };
        server_.Post(".*", discard);
        server_.Put(".*", discard);
        server_.Patch(".*", discard);
        server_.Delete(".*", discard);
    }

    void stream(const httplib::Request& request, httplib::Response& response) {
        std::shared_ptr<Stream> stream;
        {
            const std::lock_guard lock(mutex_);
            if (streams_ < kMostStreams && !isClosing_) {
                ++streams_;
                stream = std::make_shared<Stream>(*this);
            }
        }
        if (!stream) {
            response.status = 503;
            return;
        }
        const std::string last = request.get_header_value("Last-Event-ID");
        if (std::size_t number = 0;
            std::from_chars(last.data(), last.data() + last.size(), number).ec == std::errc{}) {
            stream->next = number + 1;
        }
        response.set_chunked_content_provider("text/event-stream",
                                              [this, stream](std::size_t, httplib::DataSink& sink) {
                                                  return sendNext(*stream, sink);
                                              });
    }

    /// Sends the next event, as soon as there is one. @return whether the browser is still there
    bool sendNext(Stream& stream, httplib::DataSink& sink) {
        std::shared_ptr<const std::string> event;
        {
            std::unique_lock lock(mutex_);
            changed_.wait_for(lock, kHeartbeat,
                              [&] { return isClosing_ || stream.next < events_.size(); });
            if (stream.next < events_.size()) {
                event = events_[stream.next++];
            } else if (isClosing_) {
                sink.done();
                return true;
            }
        }
        static const std::string kNothing = ":\n\n";
        const std::string& text = event ? *event : kNothing;
        return sink.write(text.data(), text.size());
    }

    ServerAddress address_;
    std::string page_;
    std::unique_ptr<httplib::TaskQueue> threads_;  // until the server takes them
    httplib::Server server_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::shared_ptr<const std::string>> events_;
    std::size_t streams_ = 0;
    bool isClosing_ = false;
    std::thread thread_;
};

LiveServer::LiveServer(const ServerAddress& address, std::string page)
    : implementation_(std::make_unique<Implementation>(address, std::move(page))) {}
LiveServer::~LiveServer() = default;
std::string LiveServer::url() const { return implementation_->url(); }
void LiveServer::publish(std::string_view name, std::string_view data) {
    implementation_->publish(name, data);
}

}  // namespace photonav
